// Looks out of a session, as files that stand for themselves.
#pragma once

#include <filesystem>
#include <vector>

#include "session/document.h"

namespace livery {

/// Writes a look file with the session's exposure, and beside it a material file for each of the
/// session's own paints that the look wears. Returns all that was written, the look first. Throws
/// std::invalid_argument (no such look), FileError.
std::vector<std::filesystem::path> export_look(const Document& document,
                                               int look_id,
                                               const std::filesystem::path& file);

}  // namespace livery
