#include "evaluation/evaluator_name.h"

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

}  // namespace livery
