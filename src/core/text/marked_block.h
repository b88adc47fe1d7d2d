// The part of a document that a command prints: what stands between two marks.
#pragma once

#include <filesystem>
#include <string>

namespace livery {

/// Puts `text` between the lines `<!-- MARK: begin -->` and `<!-- MARK: end -->` of a file. Throws
/// FileError for a file without them.
void replace_marked_block(const std::filesystem::path& file,
                          const std::string& mark,
                          const std::string& text);
/// Throws FileError as replace_marked_block() would, and changes nothing.
void check_marked_block(const std::filesystem::path& file, const std::string& mark);

}  // namespace livery
