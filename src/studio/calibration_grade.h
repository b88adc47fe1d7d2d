// How good a calibration is, against the scale of docs/calibration.md.
#pragma once

#include <string>
#include <vector>

#include "scene/colour_calibration.h"

namespace livery {

enum class Grade { good, usable, bad };
std::string to_string(Grade grade);  ///< "Good", "Usable", "Bad"

struct GradedFigure {
    std::string name;     ///< "Valid pixels"
    std::string value;    ///< "97.3 %"
    std::string scale;    ///< "good over 95 %, usable over 85 %"
    std::string meaning;  ///< a sentence
    std::string fix;      ///< what helps when it is not good
    Grade grade = Grade::good;
};

/// One a figure, in the order of the docs' table. Figures that are not finite are bad.
std::vector<GradedFigure> grade_figures(const ColourCalibration& calibration);

struct CalibrationGrade {
    Grade grade = Grade::good;
    std::string reason;  ///< the worst figure against its scale, in a sentence
    std::string fix;     ///< empty when it is good
};
CalibrationGrade grade_of(const std::vector<GradedFigure>& figures);

}  // namespace livery
