// What a calibration says of itself, and how good that is on the scale of docs/calibration.md.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "core/grade.h"
#include "scene/colour_calibration.h"

namespace livery {

/// What it was made with, its residuals and its warnings, each with its name.
std::vector<std::pair<std::string, std::string>> calibration_figures(const ColourCalibration& c);

/// One a figure, in the order of the docs' table. Figures that are not finite are bad.
std::vector<GradedFigure> grade_figures(const ColourCalibration& calibration);

}  // namespace livery
