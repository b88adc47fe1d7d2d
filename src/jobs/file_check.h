// What kind of file is this, and what is wrong with it?
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/progress.h"

namespace livery {

struct FileCheck {
    std::filesystem::path file;
    std::string kind;  ///< "mesh", "material", "look", "product", "captures", ... or "unknown"
    std::vector<std::string> problems;  ///< each one line: field, found, expected
    std::vector<std::string> notes;     ///< dropped or repaired on reading; not a problem
    bool ok() const { return problems.empty(); }
};

/// Reads the file with the reader that the program itself uses; never throws for a bad file, only
/// Cancelled. `patterns`: what photographs without a manifest of their own show (empty: the usual
/// 42 pictures).
FileCheck check_file(const std::filesystem::path& file,
                     const Progress& progress = {},
                     const std::filesystem::path& patterns = {});

}  // namespace livery
