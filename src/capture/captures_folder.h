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
    std::string transfer = "linear";  ///< "linear", "srgb" or the path of a response file
    double black_level = 0.0;         ///< file units, before the transfer is undone
    double saturates_at = 0.0;        ///< file units, before the transfer; 0: the file's full scale
    /// One pixel of each square of a RAW file's colour filter, in place of all, interpolated.
    bool raw_half = false;
    /// Where the manifest would say the exposure, for messages; empty without a manifest.
    std::string exposure_field{};
};

struct CapturesFolder {
    std::filesystem::path folder;
    int projector_width = 0, projector_height = 0;
    std::vector<Capture> captures;
};

/// What photographs are read for: places (Gray code, boards), of which only how they are exposed
/// against one another counts; or light, which is counted a second.
enum class PhotographUse { places, light };

/// Reads manifest.json; without one, files in name order are matched with `patterns_manifest` (or
/// the folder that it lies in) or, if that is empty, with the 42-picture order (20 column, 20 row,
/// white, black). Exposures that nobody states are those of complete_exposures(); without a
/// manifest, and without EXIF in any file, one second each. Without either, the projector's size is
/// 0x0: not known. Throws FileError, Refused.
CapturesFolder read_captures_folder(const std::filesystem::path& folder,
                                    PhotographUse use,
                                    const std::filesystem::path& patterns_manifest = {});

/// The folder as a camera: `turn_to` looks a role up, `photograph` loads its photographs in the
/// order of the folder, and their `taken_at` is their place in it. Nothing is shown: it was, when
/// they were taken. There is no colorimeter. Throws FileError for a role without a photograph.
BenchPorts ports_of(const CapturesFolder& folder);

/// Loads one photograph as RGB, transfer curve undone: values, black level and saturation stay on
/// the scale of the file. Floating-point files saturate nowhere unless the manifest says so. Throws
/// FileError, also for NaN and infinity.
Photograph load_photograph(const Capture& capture);

}  // namespace livery
