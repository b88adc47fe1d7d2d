#include "appearance/subsurface/scattering_medium.h"

#include <cmath>
#include <limits>
#include <stdexcept>

#include <fmt/format.h>

#include "appearance/paint_figures.h"
#include "core/mutation.h"
#include "core/quadrature.h"

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

double critical_cosine(double eta) {
    return eta > 1.0 ? std::sqrt((1.0 - 1.0 / eta) * (1.0 + 1.0 / eta)) : 0.0;
}

double inner_reflectance(double eta, double mu) {
    const double value = dielectric_reflectance(mu, 1.0 / eta);
    return std::isfinite(value) ? value : 1.0;  // 0/0 at grazing incidence on no boundary
}

FresnelMoments fresnel_moments(double eta) {
    static const auto nodes = gauss_legendre(48);
    FresnelMoments moments;
    const double critical = critical_cosine(eta);
    // All of it is reflected up to the critical cosine.
    moments.c1 = critical * critical / 2.0;
    moments.c2 = critical * critical * critical / 3.0;
    // Beyond, F leaves 1 like a root: mu = critical + (1 - critical) t^2 makes it smooth.
    for (const QuadratureNode& t : nodes) {
        const double mu = critical + (1.0 - critical) * t.at * t.at;
        const double weight = 2.0 * t.at * t.weight * (1.0 - critical);
        const double f = inner_reflectance(eta, mu);
        moments.c1 += weight * f * mu;
        moments.c2 += weight * f * mu * mu;
        const double passed = LIVERY_MUTATED(boundary_passed, weight * (1.0 - f) * mu);
        const double mu2 = mu * mu;
        moments.passed[0] += passed;
        moments.passed[1] += passed * mu;
        moments.passed[2] += passed * (3.0 * mu2 - 1.0) / 2.0;
        moments.passed[3] += passed * mu * (5.0 * mu2 - 3.0) / 2.0;
    }
    return moments;
}

}  // namespace livery
