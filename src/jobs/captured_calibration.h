// A colour calibration from a folder of photographs: what `livery calibrate color` does.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "capture/captures_folder.h"
#include "core/progress.h"
#include "jobs/calibrate/bench_calibration.h"

namespace livery {

struct CalibrationPhotographs {
    std::filesystem::path folder;              ///< or the folder of a capture in stages
    std::filesystem::path patterns_manifest;   ///< for folders without a manifest of their own
    std::optional<std::filesystem::path> map;  ///< else decoded from the same folder
};

/// Of the settings count those of the colours' fit and of where everything stands; what was shown
/// is read in the folder. Throws FileError, Refused, std::invalid_argument.
ColourCalibration calibrate_from_folder(const CalibrationPhotographs& taken,
                                        CalibrationSettings settings = {},
                                        const Progress& progress = {});

/// `--map` files: EXR in projector pixels, channels X,Y = camera pixel (OpenCV centres), NaN where
/// unknown.
ProjectorToCamera read_map(const std::filesystem::path& file,
                           int projector_width,
                           int projector_height);
void write_map(const std::filesystem::path& file, const ProjectorToCamera& map);

/// read_captures_folder(). Where there is no manifest.json, the order of the files' names is
/// checked at some of the photographs, and where it does not hold, all are looked at (identify())
/// and get the roles that they show; `warnings` then names those that are out of order, or those
/// that show none of the pictures. Throws FileError, Refused, Cancelled.
CapturesFolder read_shown_captures(const std::filesystem::path& folder,
                                   PhotographUse use,
                                   const std::filesystem::path& patterns_manifest,
                                   std::vector<std::string>& warnings,
                                   const Progress& progress = {});

}  // namespace livery
