#include "evaluation/typed_words.h"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <vector>

#include "core/error.h"
#include "core/utf8.h"

namespace livery {

namespace {

constexpr std::size_t kMaxBytes = 200;

/// The code points, or nothing when `text` is not well-formed UTF-8.
std::optional<std::vector<char32_t>> decoded(std::string_view text) {
    std::vector<char32_t> points;
    while (!text.empty()) {
        const auto point = take_code_point(text);
        if (!point) return std::nullopt;
        points.push_back(*point);
    }
    return points;
}

bool is_space(char32_t point) {
    return point == ' ' || point == '\t' || point == 0xa0 || point == 0x1680 ||
           (point >= 0x2000 && point <= 0x200b) || point == 0x202f || point == 0x205f ||
           point == 0x3000 || point == 0xfeff;
}

bool is_control(char32_t point) {
    return point < 0x20 || (point >= 0x7f && point < 0xa0) || point == 0x2028 || point == 0x2029;
}

char32_t lower(char32_t point) {
    const auto within = [&](char32_t first, char32_t last) {
        return point >= first && point <= last;
    };
    if (within('A', 'Z') || (within(0xc0, 0xde) && point != 0xd7)) return point + 0x20;
    if (point == 0x178) return 0xff;
    // Latin Extended-A: upper and lower alternate, upper first on even or on odd numbers.
    if (within(0x100, 0x137) && point != 0x130 && point != 0x131) return point | 1u;
    if (within(0x14a, 0x177)) return point | 1u;
    if (within(0x139, 0x148) || within(0x179, 0x17e)) return point % 2 == 1 ? point + 1 : point;
    // Vietnamese and other Latin letters with two marks.
    if (within(0x1e00, 0x1e95) || within(0x1ea0, 0x1eff)) return point | 1u;
    // Greek: the letters with tonos, the alphabet, and the sigma that ends a word.
    if (point == 0x386) return 0x3ac;
    if (within(0x388, 0x38a)) return point + 0x25;
    if (point == 0x38c) return 0x3cc;
    if (within(0x38e, 0x38f)) return point + 0x3f;
    if (within(0x391, 0x3ab)) return point + 0x20;
    if (point == 0x3c2) return 0x3c3;
    // Cyrillic.
    if (within(0x400, 0x40f)) return point + 0x50;
    if (within(0x410, 0x42f)) return point + 0x20;
    if (within(0x460, 0x481) || within(0x48a, 0x4bf) || within(0x4d0, 0x52f)) return point | 1u;
    return point;
}

std::vector<char32_t> tidy_points(std::string_view name) {
    const auto refuse = [](const std::string& found) {
        throw std::invalid_argument("evaluator: found " + found + ", expected a name of 1 to " +
                                    std::to_string(kMaxBytes) + " bytes");
    };
    if (name.size() > kMaxBytes) refuse(std::to_string(name.size()) + " bytes");
    const auto points = decoded(name);
    if (!points) refuse("a text that is not UTF-8");
    std::vector<char32_t> tidy;
    bool gap = false;
    for (const char32_t point : *points) {
        if (is_space(point)) {
            gap = !tidy.empty();
            continue;
        }
        if (is_control(point)) refuse("a control character");
        if (gap) tidy.push_back(' ');
        gap = false;
        tidy.push_back(point);
    }
    if (tidy.empty()) refuse("no name");
    return tidy;
}

std::string encoded(const std::vector<char32_t>& points) {
    std::string text;
    for (const char32_t point : points) append_code_point(text, point);
    return text;
}

}  // namespace

std::string tidy_name(std::string_view name) { return encoded(tidy_points(name)); }

std::string name_key(std::string_view name) {
    auto points = tidy_points(name);
    for (char32_t& point : points) point = lower(point);
    return encoded(points);
}

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
