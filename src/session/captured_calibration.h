// A colour calibration from a folder of photographs: what `livery calibrate color` does.
#pragma once

#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "calibration/capture_summary.h"
#include "calibration/colour.h"
#include "capture/captures_folder.h"
#include "core/progress.h"
#include "scene/colour_calibration.h"

namespace livery {

struct CapturedCalibrationRequest {
    std::filesystem::path captures;
    std::filesystem::path patterns_manifest;   ///< for folders without a manifest of their own
    std::optional<std::filesystem::path> map;  ///< else decoded from the same folder
    std::optional<std::filesystem::path> camera_to_xyz;
    ColourMode mode = ColourMode::robust;
};

/// Photographs in the order in which they were taken, and what the checks keep of each.
struct LoadedCaptures {
    std::vector<RoledPhotograph> geometry;  ///< of one channel
    std::vector<RoledPhotograph> colours;
    std::vector<CaptureSummary> summaries;
    std::set<std::pair<int, int>> sizes;  ///< width, height
};
void add_capture(LoadedCaptures& captures, RoledPhotograph photograph);

/// Checks the photographs against one another, decodes the map unless there is one, and solves.
/// Throws Refused, FileError, std::invalid_argument.
ColourCalibration calibrate_from_captures(LoadedCaptures captures,
                                          const std::vector<Pattern>& patterns,
                                          const std::optional<ProjectorToCamera>& map,
                                          const ColourOptions& options,
                                          const Progress& progress = {});

/// Throws FileError, Refused, std::invalid_argument.
ColourCalibration calibrate_from_folder(const CapturedCalibrationRequest& request,
                                        const Progress& progress = {});

/// `--map` files: EXR in projector pixels, channels X,Y = camera pixel (OpenCV centres), NaN where
/// unknown.
ProjectorToCamera read_map(const std::filesystem::path& file,
                           int projector_width,
                           int projector_height);
void write_map(const std::filesystem::path& file, const ProjectorToCamera& map);

}  // namespace livery
