// Archives that every desktop opens: ZIP files (PKWARE's APPNOTE 6.3, without its 64-bit fields).
#pragma once

#include <ctime>
#include <string>
#include <vector>

namespace livery {

/// A file within an archive.
struct ZipEntry {
    std::string name;   ///< relative, UTF-8, with "/" between folders
    std::string bytes;  ///< whole
};

/// The archive's bytes: the files in this order, deflated where that is shorter, all with the same
/// time of change. Throws std::invalid_argument for names that are empty, absolute, too long, given
/// twice or lead out of the archive, and for more than it can hold (65535 files, 4 GB).
std::string zip_of(const std::vector<ZipEntry>& entries, std::time_t changed);

}  // namespace livery
