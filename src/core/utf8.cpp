#include "core/utf8.h"

namespace livery {

std::optional<char32_t> take_code_point(std::string_view& text) {
    if (text.empty()) return std::nullopt;
    const auto lead = static_cast<unsigned char>(text[0]);
    const std::size_t length = lead < 0x80             ? 1
                               : (lead & 0xe0) == 0xc0 ? 2
                               : (lead & 0xf0) == 0xe0 ? 3
                               : (lead & 0xf8) == 0xf0 ? 4
                                                       : 0;
    if (length == 0 || length > text.size()) return std::nullopt;
    char32_t point = length == 1 ? lead : lead & (0x7fu >> length);
    for (std::size_t k = 1; k < length; ++k) {
        const auto next = static_cast<unsigned char>(text[k]);
        if ((next & 0xc0) != 0x80) return std::nullopt;
        point = (point << 6u) | (next & 0x3fu);
    }
    constexpr char32_t smallest[] = {0, 0, 0x80, 0x800, 0x10000};
    const bool surrogate = point >= 0xd800 && point <= 0xdfff;
    if (point < smallest[length] || point > 0x10ffff || surrogate) return std::nullopt;
    text.remove_prefix(length);
    return point;
}

void append_code_point(std::string& text, char32_t point) {
    const auto byte = [&](char32_t value) { text += static_cast<char>(value); };
    if (point < 0x80) {
        byte(point);
    } else if (point < 0x800) {
        byte(0xc0 | (point >> 6u));
        byte(0x80 | (point & 0x3f));
    } else if (point < 0x10000) {
        byte(0xe0 | (point >> 12u));
        byte(0x80 | ((point >> 6u) & 0x3f));
        byte(0x80 | (point & 0x3f));
    } else {
        byte(0xf0 | (point >> 18u));
        byte(0x80 | ((point >> 12u) & 0x3f));
        byte(0x80 | ((point >> 6u) & 0x3f));
        byte(0x80 | (point & 0x3f));
    }
}

std::string printable(std::string_view text, std::size_t longest) {
    std::string out;
    for (std::size_t characters = 0; !text.empty(); ++characters) {
        if (characters == longest) return out + "...";
        const std::string_view before = text;
        const auto point = take_code_point(text);
        if (!point) text.remove_prefix(1);
        const bool shown = point && *point >= 0x20 && !(*point >= 0x7f && *point < 0xa0) &&
                           *point != 0x2028 && *point != 0x2029;
        if (shown) {
            out += before.substr(0, before.size() - text.size());
        } else {
            out += '?';
        }
    }
    return out;
}

std::string_view trimmed(std::string_view text) {
    constexpr std::string_view kEnds = " \t\r";
    const std::size_t begin = text.find_first_not_of(kEnds);
    if (begin == std::string_view::npos) return {};
    return text.substr(begin, text.find_last_not_of(kEnds) + 1 - begin);
}

}  // namespace livery
