// The photographs of one calibration and the way from them to a calibration: the same for a folder
// of files and for a live bench, so that both are told the same causes by the same names.
#pragma once

#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "calibration/captures/capture_check.h"
#include "calibration/captures/capture_summary.h"
#include "calibration/colour/colour.h"
#include "calibration/correspondence/gray_code.h"
#include "calibration/correspondence/patterns.h"
#include "core/progress.h"
#include "scene/colour_calibration.h"

namespace livery {

/// Photographs in the order in which they were taken, and what the checks keep of each.
struct Captures {
    std::vector<RoledPhotograph> geometry;  ///< of one channel
    std::vector<RoledPhotograph> colours;
    std::vector<CaptureSummary> summaries;
    std::set<std::pair<int, int>> sizes;  ///< width, height
};

/// Gray code, white and black, of which decoding needs one channel.
bool is_geometry_role(const std::string& role);

/// `taken_at`: when, in photographs; negative: one after the photograph before.
void add_capture(Captures& captures, RoledPhotograph photograph, double taken_at = -1.0);

/// What the photographs so far say of themselves: stripes in each other's place, and all of
/// check_captures(). Photographs of several sizes are left to those who use them, who refuse them
/// by name. `with_stripes`: places are decoded from them. Throws Refused.
CaptureVerdict judge_captures(const Captures& captures,
                              int projector_width,
                              int projector_height,
                              const ShownDrives& drives,
                              bool with_stripes);

/// Where the camera sees each projector pixel. Adds to `warnings` what is odd about it. Throws
/// Refused, FileError.
ProjectorToCamera map_of_captures(const Captures& captures,
                                  int projector_width,
                                  int projector_height,
                                  std::vector<std::string>& warnings);

/// Takes a steady change of the lamp out of the colours and solves; what was warned of comes first.
ColourCalibration calibrate_judged(Captures captures,
                                   const CaptureVerdict& verdict,
                                   const std::vector<Pattern>& patterns,
                                   const ProjectorToCamera& map,
                                   const ColourOptions& options,
                                   const Progress& progress = {});

/// All of it: judges the photographs, decodes the map unless there is one and solves.
/// Throws Refused, FileError, std::invalid_argument.
ColourCalibration calibrate_from_captures(Captures captures,
                                          const std::vector<Pattern>& patterns,
                                          const std::optional<ProjectorToCamera>& map,
                                          const ColourOptions& options,
                                          const Progress& progress = {});

}  // namespace livery
