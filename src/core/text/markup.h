// Text from elsewhere in HTML and SVG, and the part of a document between two marks.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace livery {

/// Fit for an element's text and for an attribute between double quotation marks.
std::string html_escaped(std::string_view text);

/// Puts `text` between the lines `<!-- MARK: begin -->` and `<!-- MARK: end -->` of a file. Throws
/// FileError for a file without them.
void replace_marked_block(const std::filesystem::path& file,
                          const std::string& mark,
                          const std::string& text);
/// Throws FileError as replace_marked_block() would, and changes nothing.
void check_marked_block(const std::filesystem::path& file, const std::string& mark);

}  // namespace livery
