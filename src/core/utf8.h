// Texts from elsewhere: code points, and what may stand in a message.
#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <string_view>

namespace livery {

/// Takes the first code point off the text. Nothing, and the text as it was, when it is empty or
/// does not begin with well-formed UTF-8.
std::optional<char32_t> take_code_point(std::string_view& text);

/// The code point as UTF-8 at the text's end; it must be one of those take_code_point() returns.
void append_code_point(std::string& text, char32_t point);

/// The text as one line of UTF-8, fit for a message or a name: control characters and bytes that
/// are not UTF-8 become "?"; more than `longest` characters are cut off with "...".
std::string printable(std::string_view text,
                      std::size_t longest = std::numeric_limits<std::size_t>::max());

/// Without the spaces, tabs and carriage returns at its ends; a part of `text`.
std::string_view trimmed(std::string_view text);

}  // namespace livery
