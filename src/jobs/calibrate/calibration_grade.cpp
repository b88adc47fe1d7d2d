#include "jobs/calibrate/calibration_grade.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/worst_error.h"

namespace livery {

std::vector<std::pair<std::string, std::string>> calibration_figures(const ColourCalibration& c) {
    const auto percent = [](double fraction) { return fmt::format("{:.1f}%", 100.0 * fraction); };
    std::vector<std::pair<std::string, std::string>> figures = {
        {"Made", c.created},
        {"With", c.made_with},
        {"Mode", c.mode},
        {"Camera to XYZ", c.xyz_origin},
        {"Additivity error", percent(c.additivity_error)},
        {"Condition of the mixing, 99th percentile", fmt::format("{:.2f}", c.condition_p99)},
        {"Measured, of the lit pixels", percent(c.valid_fraction)},
        {"Predicted, of the valid pixels", percent(c.predicted_fraction)},
        {"Ambient over white", percent(c.ambient_fraction)}};
    for (const std::string& warning : c.warnings) figures.emplace_back("Warning", warning);
    return figures;
}

std::vector<GradedFigure> grade_figures(const ColourCalibration& calibration) {
    std::vector<GradedFigure> figures;
    figures.push_back(
        graded_share("Valid pixels",
                     calibration.valid_fraction,
                     0.95,
                     0.85,
                     "Measured pixels, of all that the projector lights. The others are "
                     "predicted, follow their neighbours in small gaps, or fade to black.",
                     "Move the camera nearer to the projector, or take more photographs."));
    if (calibration.predicted_fraction > 0.0) {
        figures.push_back({"Predicted pixels",
                           fmt::format("{:.1f} %", 100.0 * calibration.predicted_fraction),
                           "",
                           "Hidden from the camera; worked out from the mesh and the pose.",
                           "",
                           Grade::good});
        figures.push_back(graded_share("Prediction error",
                                       calibration.prediction_error_median,
                                       0.02,
                                       0.10,
                                       "How well measured pixels are predicted without their "
                                       "surroundings.",
                                       "Check the pose of the mock-up and its mesh."));
    }
    figures.push_back(
        graded_share("Additivity error",
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
                       grade_of(calibration.condition_p99, 3.0, 10.0)});
    figures.push_back(graded_share("Room light",
                                   calibration.ambient_fraction,
                                   0.01,
                                   0.05,
                                   "The dark picture's brightness over the bright one's.",
                                   "Darken the room."));
    double violation = 0.0;
    for (const ResponseCurve& curve : calibration.response) {
        violation = worse_of(violation, curve.largest_violation);
    }
    figures.push_back(graded_share("Response fall",
                                   violation,
                                   0.01,
                                   0.03,
                                   "How far the measured response fell before it was made rising.",
                                   "Switch dynamic contrast and picture processing off."));
    return figures;
}

}  // namespace livery
