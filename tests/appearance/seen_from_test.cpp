// From where a surface is shaded that faces away from the eye.
#include <cmath>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "appearance/bsdf_source.h"
#include "appearance/paint_figures.h"
#include "core/random.h"
#include "core/worst_error.h"

namespace livery {
namespace {

glm::dvec3 any_direction(Random& random) {
    const double z = 2.0 * random.uniform() - 1.0, phi = 2.0 * M_PI * random.uniform();
    const double r = std::sqrt((1.0 - z) * (1.0 + z));
    return {r * std::cos(phi), r * std::sin(phi), z};
}

/// At that cosine to the normal.
glm::dvec3 direction_at(double cosine, const glm::dvec3& normal, Random& random) {
    const glm::dvec3 other = any_direction(random);
    const glm::dvec3 across = glm::normalize(other - glm::dot(other, normal) * normal);
    return cosine * normal + std::sqrt((1.0 - cosine) * (1.0 + cosine)) * across;
}

TEST(SeenFrom, IsTheEyeWhereItSeesAndAboveTheHorizonWhereNot) {
    Random random(11, 1);
    double worst = 0.0;
    for (int k = 0; k < 20000; ++k) {
        const glm::dvec3 normal = any_direction(random);
        // Grazing and opposite as often as anything between
        const double u = random.uniform();
        const double size = k % 3 == 0   ? std::pow(10.0, -9.0 * u)
                            : k % 3 == 1 ? 1.0 - std::pow(10.0, -9.0 * u)
                                         : u;
        const double cosine = k % 2 == 0 ? size : -size;
        const glm::dvec3 wo = direction_at(cosine, normal, random);
        const glm::dvec3 from = f64::seen_from(wo, normal);
        // Lifted to 1e-4, what lies lower is half as much too long.
        const double too_long = std::abs(cosine) < 1e-4 ? 5.1e-5 : 1e-7;
        EXPECT_NEAR(glm::length(from), 1.0, too_long) << cosine;
        EXPECT_GE(glm::dot(from, normal), 1e-4 * (1.0 - 1e-9)) << cosine;
        if (cosine >= 1e-4) {
            EXPECT_LT(glm::distance(from, wo), 1e-9) << cosine;
        }
        const glm::dvec3 in_float(f32::seen_from(glm::vec3(wo), glm::vec3(normal)));
        worst = worse_of(worst, glm::distance(in_float, from));
    }
    // Directions have 6e-8 of their own, and the cosine of what faces away thrice that.
    EXPECT_LT(worst, 2e-6);
}

TEST(SeenFrom, HasNoStep) {
    Random random(12, 1);
    const glm::dvec3 normal(0.0, 0.0, 1.0), wo = direction_at(0.0, normal, random);
    glm::dvec3 last = f64::seen_from(wo, normal);
    constexpr int kSteps = 1000;
    for (int k = 0; k <= kSteps; ++k) {
        const double angle = 0.5 * M_PI * k / kSteps;
        const glm::dvec3 next =
            f64::seen_from(std::cos(angle) * wo - std::sin(angle) * normal, normal);
        // Thrice as far up as it went down
        EXPECT_LT(glm::distance(next, last), 3.1 * 0.5 * M_PI / kSteps) << angle;
        last = next;
    }
    EXPECT_LT(glm::distance(last, normal), 1e-6);
    EXPECT_EQ(f32::seen_from(glm::vec3(0, 0, -1), glm::vec3(0, 0, 1)), glm::vec3(0, 0, 1));
}

TEST(SeenFrom, ShowsNoFogOnBlackGlass) {
    // Fifteen degrees beyond the horizon it mirrors little more than seen from above; on the
    // horizon it would mirror all.
    const glm::dvec3 normal(0.0, 0.0, 1.0);
    const auto reflectance = [&](double degrees_below) {
        const double angle = degrees_below * M_PI / 180.0;
        const glm::dvec3 wo(std::cos(angle), 0.0, -std::sin(angle));
        return dielectric_reflectance(glm::dot(f64::seen_from(wo, normal), normal), 1.5);
    };
    EXPECT_GT(reflectance(0.0), 0.99);
    EXPECT_LT(reflectance(15.0), 0.07);
    EXPECT_LT(reflectance(30.0), 0.045);
    EXPECT_NEAR(reflectance(90.0), 0.04, 1e-4);
}

}  // namespace
}  // namespace livery
