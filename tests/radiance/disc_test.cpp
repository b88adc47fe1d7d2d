// A lobe's mean over a disc of half vectors, against its sum point by point.
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "appearance/bsdf.h"

#define REAL Real
#define VEC2 Vec2
#define VEC3 Vec3
#define R(x) Real(x)
#define FN inline
namespace livery::f64 {
#include "shaders/radiance/disc.glsl"
}  // namespace livery::f64
#undef REAL
#undef VEC2
#undef VEC3
#undef R
#undef FN

namespace livery {
namespace {

/// Density of GGX slopes.
double slope_density(const glm::dvec2& slope, double alpha) {
    const double a2 = alpha * alpha;
    const double spread = glm::dot(slope, slope) + a2;
    return a2 / (std::numbers::pi * spread * spread);
}

/// Mean over a disc, ring by ring.
double mean_over_disc(const glm::dvec2& centre, double radius, double alpha) {
    constexpr int kRings = 200, kAround = 200;
    double sum = 0.0;
    for (int i = 0; i < kRings; ++i) {
        const double r = radius * std::sqrt((i + 0.5) / kRings);
        for (int k = 0; k < kAround; ++k) {
            const double phi = 2.0 * std::numbers::pi * (k + 0.5) / kAround;
            sum += slope_density(centre + r * glm::dvec2(std::cos(phi), std::sin(phi)), alpha);
        }
    }
    return sum / (kRings * kAround);
}

TEST(Disc, IsTheLobesMeanOverIt) {
    // Where half of the light's half-angle is 0.02 and a pixel's normals vary as much.
    constexpr double kLightRadius = 0.04, kSlope2 = 4e-4;
    for (const double alpha : {0.01, 0.03, 0.1}) {
        for (const double tilt : {0.0, 0.02, 0.06}) {
            for (const bool by_light : {true, false}) {
                const glm::dvec3 wo = glm::normalize(glm::dvec3(0.3, 0.1, 0.9));
                const glm::dvec3 h = glm::normalize(glm::dvec3(tilt, 0.5 * tilt, 1.0));
                const glm::dvec3 wi = 2.0 * glm::dot(wo, h) * h - wo;
                const glm::dvec3 sum = wi + wo;
                const double hh = glm::dot(sum, sum), c = h.z;
                const double light2 = by_light ? kLightRadius * kLightRadius : 0.0;
                const double slope2 = by_light ? 0.0 : kSlope2;
                // As the head of disc.glsl has it
                const double radius2 = light2 / (2.0 * std::sqrt(hh) * c * c * c) + 2.0 * slope2;
                const glm::dvec2 slope(h.x / h.z, h.y / h.z);
                const double mean = mean_over_disc(slope, std::sqrt(radius2), alpha);
                const double point = f64::ggx_distribution_visibility(wi, wo, hh, alpha, alpha);
                const double found = f64::disc_distribution_visibility(
                    wi, wo, hh, glm::dvec2(alpha), light2, slope2);
                EXPECT_NEAR(found / point, mean / slope_density(slope, alpha), 2e-3 * found / point)
                    << "alpha " << alpha << " tilt " << tilt << " light " << by_light;
            }
        }
    }
}

}  // namespace
}  // namespace livery
