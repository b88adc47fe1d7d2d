// What a calibration says of itself, for people.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "scene/colour_calibration.h"

namespace livery {

/// What it was made with, its residuals and its warnings, each with its name.
std::vector<std::pair<std::string, std::string>> calibration_figures(const ColourCalibration& c);

}  // namespace livery
