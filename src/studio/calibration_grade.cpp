#include "studio/calibration_grade.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace livery {

namespace {

/// Beyond `good` a figure is usable, beyond `usable` it is bad; which way is beyond, their order
/// says.
Grade grade(double value, double good, double usable) {
    if (!std::isfinite(value)) return Grade::bad;
    const double sign = good > usable ? -1.0 : 1.0;
    if (sign * value < sign * good) return Grade::good;
    return sign * value < sign * usable ? Grade::usable : Grade::bad;
}

std::string percent(double fraction) { return fmt::format("{:.1f} %", 100.0 * fraction); }

GradedFigure share(std::string name,
                   double value,
                   double good,
                   double usable,
                   std::string meaning,
                   std::string fix) {
    const char* word = good > usable ? "over" : "under";
    return {std::move(name),
            percent(value),
            fmt::format("good {0} {1:g} %, usable {0} {2:g} %", word, 100.0 * good, 100.0 * usable),
            std::move(meaning),
            std::move(fix),
            grade(value, good, usable)};
}

}  // namespace

std::string to_string(Grade grade) {
    switch (grade) {
        case Grade::good:
            return "Good";
        case Grade::usable:
            return "Usable";
        case Grade::bad:
            return "Bad";
    }
    throw std::invalid_argument("unknown grade");
}

std::vector<GradedFigure> grade_figures(const ColourCalibration& calibration) {
    std::vector<GradedFigure> figures;
    figures.push_back(share("Valid pixels",
                            calibration.valid_fraction,
                            0.95,
                            0.85,
                            "Measured pixels, of all that the projector lights. The others stay "
                            "black unless they can be predicted.",
                            "Move the camera nearer to the projector, or take more photographs."));
    if (calibration.predicted_fraction > 0.0) {
        figures.push_back({"Predicted pixels",
                           percent(calibration.predicted_fraction),
                           "",
                           "Hidden from the camera; worked out from the mesh and the pose.",
                           "",
                           Grade::good});
        figures.push_back(share("Prediction error",
                                calibration.prediction_error_median,
                                0.02,
                                0.10,
                                "How well measured pixels are predicted without their "
                                "surroundings.",
                                "Check the pose of the mock-up and its mesh."));
    }
    figures.push_back(share("Additivity error",
                            calibration.additivity_error,
                            0.02,
                            0.05,
                            "How far the projector's white is from the sum of its red, green and "
                            "blue.",
                            "Set the projector to its sRGB or cinema mode."));
    figures.push_back({"Condition",
                       fmt::format("{:.2f}", calibration.condition_p99),
                       "good under 3, usable under 10",
                       "How much separating the channels amplifies the camera's noise.",
                       "Try another camera or white balance, and a neutral mock-up.",
                       grade(calibration.condition_p99, 3.0, 10.0)});
    figures.push_back(share("Room light",
                            calibration.ambient_fraction,
                            0.01,
                            0.05,
                            "The dark picture's brightness over the bright one's.",
                            "Darken the room."));
    double violation = 0.0;
    for (const ResponseCurve& curve : calibration.response) {
        violation = std::isfinite(curve.largest_violation)
                        ? std::max(violation, curve.largest_violation)
                        : curve.largest_violation;
    }
    figures.push_back(share("Response fall",
                            violation,
                            0.01,
                            0.03,
                            "How far the measured response fell before it was made rising.",
                            "Switch dynamic contrast and picture processing off."));
    return figures;
}

CalibrationGrade grade_of(const std::vector<GradedFigure>& figures) {
    const auto worst = std::max_element(
        figures.begin(), figures.end(), [](const GradedFigure& a, const GradedFigure& b) {
            return a.grade < b.grade;
        });
    if (worst == figures.end() || worst->grade == Grade::good) {
        return {Grade::good, "every figure is within its good range", ""};
    }
    return {worst->grade,
            fmt::format("{} {} ({})", worst->name, worst->value, worst->scale),
            worst->fix};
}

}  // namespace livery
