#include "evaluation/semantic_scale.h"

#include <algorithm>
#include <cstddef>
#include <optional>

#include "core/error.h"
#include "core/utf8.h"
#include "evaluation/evaluator_name.h"

namespace livery {

namespace {

/// What is not to be seen, or turns what follows around.
bool is_invisible(char32_t point) {
    return point < 0x20 || (point >= 0x7f && point < 0xa0) || point == 0xad ||
           (point >= 0x200b && point <= 0x200f) || (point >= 0x2028 && point <= 0x202e) ||
           (point >= 0x2060 && point <= 0x206f) || point == 0xfeff ||
           (point >= 0xfff9 && point <= 0xfffb);
}

void check_word(const std::string& word) {
    const auto refuse = [](const std::string& found) {
        throw std::invalid_argument("scale: found " + found + ", expected two words of 1 to " +
                                    std::to_string(kLongestScaleWord) +
                                    " characters each with a comma between");
    };
    if (word.empty()) refuse("an empty word");
    std::string_view left = word;
    std::size_t characters = 0;
    while (!left.empty()) {
        const auto point = take_code_point(left);
        if (!point) refuse("a text that is not UTF-8");
        if (is_invisible(*point)) refuse("a character that is not to be seen");
        if (*point == ',' || *point == ';') refuse("\"" + printable(word, 40) + "\"");
        ++characters;
    }
    if (characters > kLongestScaleWord) refuse(std::to_string(characters) + " characters");
    if (word.front() == ' ' || word.back() == ' ') refuse("white space around a word");
}

}  // namespace

SemanticScale parse_scale(std::string_view text) {
    const std::size_t comma = text.find(',');
    check_argument(comma != std::string_view::npos,
                   "scale: found \"" + printable(text, 60) +
                       "\", expected two words with a comma between, as \"cheap,precious\"");
    SemanticScale scale{std::string(trimmed(text.substr(0, comma))),
                        std::string(trimmed(text.substr(comma + 1)))};
    check_scale(scale);
    return scale;
}

std::string text_of(const SemanticScale& scale) { return scale.low + "," + scale.high; }

std::string in_words(const SemanticScale& scale) { return scale.low + " – " + scale.high; }

void check_scale(const SemanticScale& scale) {
    check_word(scale.low);
    check_word(scale.high);
    check_argument(
        name_key(scale.low) != name_key(scale.high),
        "scale: found \"" + printable(scale.low) + "\" at both ends, expected opposites");
}

void check_scales(const std::vector<SemanticScale>& scales) {
    check_argument(scales.size() <= kMostScales,
                   "scales: found " + std::to_string(scales.size()) + ", expected at most " +
                       std::to_string(kMostScales));
    for (std::size_t k = 0; k < scales.size(); ++k) {
        check_scale(scales[k]);
        const auto same =
            std::find(scales.begin(), scales.begin() + static_cast<std::ptrdiff_t>(k), scales[k]);
        check_argument(same == scales.begin() + static_cast<std::ptrdiff_t>(k),
                       "scales: found \"" + text_of(scales[k]) + "\" twice");
    }
}

const std::vector<SemanticScale>& suggested_scales() {
    static const std::vector<SemanticScale> scales = {{"cheap", "precious"},
                                                      {"plain", "striking"},
                                                      {"cold", "warm"},
                                                      {"old-fashioned", "modern"},
                                                      {"playful", "serious"}};
    return scales;
}

}  // namespace livery
