// How good a calibration is, against the scale of docs/calibration.md.
#pragma once

#include <vector>

#include "core/grade.h"
#include "scene/colour_calibration.h"

namespace livery {

/// One a figure, in the order of the docs' table. Figures that are not finite are bad.
std::vector<GradedFigure> grade_figures(const ColourCalibration& calibration);

}  // namespace livery
