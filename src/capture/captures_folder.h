// A folder of photographs with its manifest, or without one (docs/files.md).
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/bench_ports.h"

namespace livery {

struct Capture {
    std::string role;
    std::filesystem::path file;
    std::filesystem::path pattern;  ///< picture that was shown; empty when not known
    std::vector<int> drive;         ///< device values of a uniform picture; empty otherwise
    double exposure_s = 0.0;
    std::string transfer = "linear";
    double black_level = 0.0;
    double saturates_at = 0.0;
};

struct CapturesFolder {
    std::filesystem::path folder;
    int projector_width = 0, projector_height = 0;
    std::vector<Capture> captures;
};

/// Reads manifest.json; without one, files in name order are matched with `patterns_manifest` or,
/// if that is empty, with the 42-picture order (20 column, 20 row, white, black). Throws FileError.
CapturesFolder read_captures_folder(const std::filesystem::path& folder,
                                    const std::filesystem::path& patterns_manifest = {});

/// Loads one photograph, transfer curve undone (values stay in file units). Throws FileError.
Photograph load_photograph(const Capture& capture);

}  // namespace livery
