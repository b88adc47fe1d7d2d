// What cutting drives to whole levels makes of a picture.
#pragma once

#include <vector>

#include "compensation/compensation.h"
#include "core/image.h"

namespace livery {

/// Drives, 0 to 255, to the nearest whole level, without dither.
Image8 rounded_drive(const ImageF& exact);

/// CIEDE2000 between what a drive and the exact one show by the calibration's own model
/// (shown_by()), light averaged over squares of `side_px` pixels that all have a correction: an eye
/// that is far away sees no less than that.
std::vector<float> drive_errors(const CompensationTable& table,
                                const Image8& drive,
                                const ImageF& exact,
                                int side_px);

/// Of correcting a frame on the processor, the median of several.
double compensation_ms(const CompensationTable& table, const ImageF& wanted_working);

}  // namespace livery
