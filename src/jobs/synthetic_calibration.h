// A calibration that costs as much to apply as a real one, without photographs: for the speed
// bench, which times the arithmetic and does not judge colours.
#pragma once

#include "core/image.h"
#include "scene/colour_calibration.h"

namespace livery {

/// Every pixel with coverage of at least half is valid; mixing and scale vary over the picture.
ColourCalibration synthetic_calibration(const ImageF& coverage);

}  // namespace livery
