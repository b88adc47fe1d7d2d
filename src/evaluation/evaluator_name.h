// When two typed names are one person.
#pragma once

#include <string>
#include <string_view>

namespace livery {

/// Without the white space around it, and single spaces within. Throws std::invalid_argument:
/// empty, over 200 bytes, not UTF-8, control characters.
std::string tidy_name(std::string_view name);

/// Equal for names of one person: tidy, and lower case in the Latin, Greek and Cyrillic alphabets
/// ("ÅSA" and "åsa"). No locale is asked, so a file means the same everywhere.
std::string name_key(std::string_view name);

}  // namespace livery
