#include "appearance/subsurface/normalized_diffusion.h"

#include <cmath>
#include <numbers>

namespace livery {

NormalizedDiffusion::NormalizedDiffusion(double total_reflectance, double mean_free_path_mm)
    : albedo(total_reflectance) {
    const double off = std::abs(albedo - 0.8);
    d_mm = mean_free_path_mm / (1.85 - albedo + 7.0 * off * off * off);
}

double NormalizedDiffusion::at(double radius_mm) const {
    const double x = radius_mm / d_mm;
    return albedo * (std::exp(-x) + std::exp(-x / 3.0)) /
           (8.0 * std::numbers::pi * d_mm * radius_mm);
}

double NormalizedDiffusion::cumulative(double radius_mm) const {
    const double x = radius_mm / d_mm;
    return 1.0 - 0.25 * std::exp(-x) - 0.75 * std::exp(-x / 3.0);
}

}  // namespace livery
