#include "session/naming.h"

#include <algorithm>
#include <string_view>

#include "core/error.h"
#include "core/utf8.h"

namespace livery {

namespace {

constexpr std::size_t kLongestName = 200;
constexpr std::size_t kLongestText = 16'384;

}  // namespace

void check_text(const std::string& text, const std::string& what) {
    check_argument(text.size() <= kLongestText,
                   what + " has " + std::to_string(text.size()) + " bytes; at most " +
                       std::to_string(kLongestText) + " are possible");
    for (std::string_view rest = text; !rest.empty();) {
        const auto point = take_code_point(rest);
        check_argument(point.has_value(), what + " is not UTF-8 text");
        check_argument(*point >= 0x20 && *point != 0x7F, what + " contains a control character");
    }
}

void check_name(const std::string& text, const std::string& what) {
    check_argument(text.find_first_not_of(' ') != std::string::npos, what + " is empty");
    check_argument(text.size() <= kLongestName,
                   what + " has " + std::to_string(text.size()) + " bytes; at most " +
                       std::to_string(kLongestName) + " are possible");
    check_text(text, what);
}

std::string without_number(const std::string& name) {
    const auto space = name.find_last_of(' ');
    if (space == std::string::npos || space == 0 || space + 1 == name.size()) return name;
    const bool digits = std::all_of(name.begin() + static_cast<std::ptrdiff_t>(space) + 1,
                                    name.end(),
                                    [](char c) { return c >= '0' && c <= '9'; });
    return digits ? name.substr(0, space) : name;
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
