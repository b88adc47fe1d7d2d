#include "session/naming.h"

#include <algorithm>

#include "core/error.h"

namespace livery {

namespace {

constexpr std::size_t kLongestName = 200;
constexpr std::size_t kLongestText = 16'384;

bool is_continuation(unsigned char c) { return (c & 0xC0u) == 0x80u; }

/// Bytes of the UTF-8 character at `k`; 0 when there is none.
std::size_t character_length(const std::string& text, std::size_t k) {
    const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
    const unsigned char first = byte(k);
    if (first < 0x80u) return 1;
    const std::size_t length = first >= 0xF0u ? 4 : first >= 0xE0u ? 3 : 2;
    if (first < 0xC2u || first > 0xF4u || k + length > text.size()) return 0;
    for (std::size_t i = 1; i < length; ++i) {
        if (!is_continuation(byte(k + i))) return 0;
    }
    const unsigned char second = byte(k + 1);
    const bool overlong = (first == 0xE0u && second < 0xA0u) || (first == 0xF0u && second < 0x90u);
    const bool surrogate = first == 0xEDu && second > 0x9Fu;
    const bool too_large = first == 0xF4u && second > 0x8Fu;
    return overlong || surrogate || too_large ? 0 : length;
}

/// "solid red 2" -> "solid red"; a name without such a number comes back as it is.
std::string without_number(const std::string& name) {
    const auto space = name.find_last_of(' ');
    if (space == std::string::npos || space == 0 || space + 1 == name.size()) return name;
    const bool digits = std::all_of(name.begin() + static_cast<std::ptrdiff_t>(space) + 1,
                                    name.end(),
                                    [](char c) { return c >= '0' && c <= '9'; });
    return digits ? name.substr(0, space) : name;
}

}  // namespace

void check_text(const std::string& text, const std::string& what) {
    check_argument(text.size() <= kLongestText,
                   what + " has " + std::to_string(text.size()) + " bytes; at most " +
                       std::to_string(kLongestText) + " are possible");
    for (std::size_t k = 0; k < text.size();) {
        const std::size_t length = character_length(text, k);
        check_argument(length != 0, what + " is not UTF-8 text");
        const auto c = static_cast<unsigned char>(text[k]);
        check_argument(c >= 0x20u && c != 0x7Fu, what + " contains a control character");
        k += length;
    }
}

void check_name(const std::string& text, const std::string& what) {
    check_argument(text.find_first_not_of(' ') != std::string::npos, what + " is empty");
    check_argument(text.size() <= kLongestName,
                   what + " has " + std::to_string(text.size()) + " bytes; at most " +
                       std::to_string(kLongestName) + " are possible");
    check_text(text, what);
}

std::string free_name(const std::string& name,
                      const std::function<bool(const std::string&)>& taken) {
    if (!taken(name)) return name;
    // Only a number that we put there is one: a paint called "RAL 3020" has its name from
    // elsewhere.
    const std::string shorter = without_number(name);
    const std::string stem = taken(shorter) ? shorter : name;
    for (int number = 2;; ++number) {
        const std::string candidate = stem + " " + std::to_string(number);
        if (!taken(candidate)) return candidate;
    }
}

}  // namespace livery
