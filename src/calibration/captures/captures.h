// The photographs of one calibration and the way from them to a calibration.
#pragma once

#include <string>
#include <vector>

#include "calibration/captures/capture_check.h"
#include "calibration/captures/capture_summary.h"
#include "calibration/colour/colour.h"
#include "calibration/correspondence/fringe_decode.h"
#include "calibration/correspondence/gray_code.h"
#include "calibration/correspondence/patterns.h"
#include "core/progress.h"
#include "scene/colour_calibration.h"

namespace livery {

/// Photographs of one size, and what the checks keep of each.
struct Captures {
    std::vector<RoledPhotograph> geometry;  ///< of one channel
    std::vector<RoledPhotograph> colours;
    std::vector<CaptureSummary> summaries;  ///< in the order in which they were taken
    int width = 0;                          ///< of the photographs
};

/// Gray code, fringes, white and black, of which decoding needs one channel.
bool is_geometry_role(const std::string& role);

void add_capture(Captures& captures, RoledPhotograph photograph);

/// What the photographs so far say of themselves: stripes in each other's place, and all of
/// check_captures(). `with_stripes`: places are decoded from them. Throws Refused.
CaptureVerdict judge_captures(const Captures& captures,
                              const CalibrationSettings& settings,
                              bool with_stripes);

/// Where the camera sees each projector pixel, by decode_places(). Adds to `warnings` what is odd
/// about it. `light`, where it is asked for, gets what fringes tell apart. Throws Refused,
/// FileError.
ProjectorToCamera map_of_captures(const Captures& captures,
                                  int projector_width,
                                  int projector_height,
                                  std::vector<std::string>& warnings,
                                  SeparatedLight* light = nullptr);

/// Takes a steady change of the lamp out of `captures`' colours and solves; what was warned of
/// comes first.
ColourCalibration calibrate_judged(Captures& captures,
                                   const CaptureVerdict& verdict,
                                   const std::vector<Pattern>& patterns,
                                   const ProjectorToCamera& map,
                                   const CalibrationSettings& settings,
                                   const Progress& progress = {});

}  // namespace livery
