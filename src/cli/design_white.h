// The white that a correction is scaled to, and what answers say of it.
#pragma once

#include <cstddef>
#include <string>

#include "cli/command.h"
#include "core/image.h"
#include "scene/colour_calibration.h"

namespace livery {

struct DesignWhite {
    double y = 0.0;           ///< luminance on the scale of the calibration's XYZ
    double percentile = 0.0;  ///< of the pixels that count
    std::string mask;         ///< in words: which pixels count
    std::size_t pixels = 0;   ///< how many of them are valid
};

/// `counted`: non-zero counts; empty: all. `mask` says in words what it holds.
DesignWhite design_white_of(const ColourCalibration& calibration,
                            double percentile,
                            const Image8& counted,
                            std::string mask);

/// "design white 0.3, the 20th percentile of 5000 pixels: coverage"
std::string text_of(const DesignWhite& white);
/// design_white_y, design_white_mask and design_white_pixels.
void tell(const DesignWhite& white, Outcome& outcome);

}  // namespace livery
