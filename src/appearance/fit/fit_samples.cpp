#include "appearance/fit/fit_samples.h"

#include <cmath>
#include <numbers>

namespace livery {

namespace {

constexpr double kLargestTheta_rad = 80.0 * std::numbers::pi / 180.0;

}  // namespace

FitSamples fit_samples(const ReflectanceFunction& truth_working,
                       const std::function<bool(const DirectionPair&)>& is_measured,
                       FitGridSize size) {
    FitSamples samples;
    const double lowest = std::cos(kLargestTheta_rad);
    for (int i = 0; i < size.theta_h; ++i) {
        const double root = (i + 0.5) / size.theta_h;
        const double theta_h = 0.5 * std::numbers::pi * root * root;
        const glm::dvec3 h(std::sin(theta_h), 0.0, std::cos(theta_h));
        const glm::dvec3 across(std::cos(theta_h), 0.0, -std::sin(theta_h));
        for (int j = 0; j < size.theta_d; ++j) {
            const double theta_d = kLargestTheta_rad * (j + 0.5) / size.theta_d;
            for (int k = 0; k < size.phi_d; ++k) {
                const double phi_d = std::numbers::pi * (k + 0.5) / size.phi_d;
                const glm::dvec3 aside =
                    std::sin(theta_d) *
                    (std::cos(phi_d) * across + glm::dvec3(0.0, std::sin(phi_d), 0.0));
                const DirectionPair pair{std::cos(theta_d) * h + aside,
                                         std::cos(theta_d) * h - aside};
                if (pair.wi.z < lowest || pair.wo.z < lowest || !is_measured(pair)) continue;
                samples.pairs.push_back(pair);
                samples.values_working.push_back(truth_working(pair.wi, pair.wo));
            }
        }
    }
    return samples;
}

}  // namespace livery
