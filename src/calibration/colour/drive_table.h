// Projectors whose white is more than the sum of their channels: N as a function of all three
// drives.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

#include "calibration/colour/response.h"
#include "scene/colour_calibration.h"

namespace livery {

/// Separated colour per unit T - S that one drive gave.
struct TableSample {
    std::array<std::uint8_t, 3> drive;
    glm::dvec3 n;
    double variance;
};

struct TableFit {
    DriveTable table;
    std::array<ResponseCurve, 3> response;  ///< of each channel alone, 0 to 1
    double rms_error = 0.0;                 ///< of the samples about the fit, in N
};

/// Fits what a channel gives alone, then what common light of two and of three channels adds
/// (a clear wheel segment adds light by the smallest of the three), each as a smooth curve of any
/// shape. Samples must hold ramps of each single channel. Throws Refused when they do not, or when
/// the fit leaves more than 2%.
TableFit fit_drive_table(const std::vector<TableSample>& samples);

}  // namespace livery
