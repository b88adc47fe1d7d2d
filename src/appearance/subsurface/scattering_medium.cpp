#include "appearance/subsurface/scattering_medium.h"

#include <cmath>
#include <limits>
#include <stdexcept>

#include <fmt/format.h>

#include "appearance/subsurface/fresnel_moments.h"

namespace livery {

double ScatteringMedium::albedo_prime() const {
    const double all = sigma_t_prime();
    return all > 0.0 ? sigma_s_prime() / all : 0.0;
}

double ScatteringMedium::reduced_depth() const {
    return thickness_mm ? sigma_t_prime() * *thickness_mm : std::numeric_limits<double>::infinity();
}

UnscatteredLight unscattered_light(const ScatteringMedium& medium) {
    UnscatteredLight light;
    const double mirrored = inner_reflectance(medium.eta, 1.0);
    light.specular = mirrored;
    if (!medium.thickness_mm) return light;
    const double once = std::exp(-medium.sigma_t() * *medium.thickness_mm);
    const double through = (1.0 - mirrored) * once / (1.0 - mirrored * mirrored * once * once);
    light.transmitted = through;
    light.reflected = through * mirrored * once;
    return light;
}

double least_radius_mm(const ScatteringMedium& medium) {
    return medium.sigma_t_prime() > 0.0 ? 1e-3 * medium.mean_free_path_mm() : 0.0;
}

void check_medium(const ScatteringMedium& medium) {
    const auto check = [](bool holds, const char* what, double found, const char* expected) {
        if (holds) return;
        throw std::invalid_argument(
            fmt::format("{}: found {}, expected {}", what, found, expected));
    };
    const auto coefficient = [](double value) {
        return value >= 0.0 && value <= kLargestCoefficient_per_mm;
    };
    constexpr const char* kCoefficients = "0 to 1000000 per mm";
    check(coefficient(medium.sigma_a_per_mm), "sigma_a", medium.sigma_a_per_mm, kCoefficients);
    check(coefficient(medium.sigma_s_per_mm), "sigma_s", medium.sigma_s_per_mm, kCoefficients);
    check(std::abs(medium.g) < 1.0, "g", medium.g, "a mean cosine above -1 and below 1");
    check(medium.eta >= 0.5 && medium.eta <= 4.0, "eta", medium.eta, "an index from 0.5 to 4");
    if (medium.thickness_mm) {
        check(*medium.thickness_mm > 0.0 && *medium.thickness_mm <= kThickest_mm,
              "thickness",
              *medium.thickness_mm,
              "above 0 and up to 1000000 mm");
    }
}

}  // namespace livery
