#include "jobs/calibrate/calibration_figures.h"

#include <fmt/format.h>

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

}  // namespace livery
