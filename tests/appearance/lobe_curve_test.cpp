#include "appearance/lobe_curve.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "appearance/bsdf.h"

namespace livery {
namespace {

Material ggx(double alpha) {
    Material material;
    material.model = ReflectanceModel::ggx;
    material.diffuse = {0.2, 0.1, 0.05};
    material.f0 = {0.5, 0.5, 0.5};
    material.alpha = {alpha, alpha};
    return material;
}

TEST(LobeCurve, RunsFromHorizonToHorizonInOrder) {
    for (const double light : {0.0, 0.4, 1.2, 0.5 * std::numbers::pi}) {
        const auto curve = lobe_curve(ggx(0.3), light);
        EXPECT_LT(curve.front().theta_o_rad, -0.499 * std::numbers::pi);
        EXPECT_GT(curve.back().theta_o_rad, 0.499 * std::numbers::pi);
        EXPECT_TRUE(std::is_sorted(curve.begin(), curve.end(), [](const auto& a, const auto& b) {
            return a.theta_o_rad < b.theta_o_rad;
        }));
        for (const LobePoint& point : curve) {
            EXPECT_TRUE(std::isfinite(point.value.x) && point.value.x >= 0.0) << light;
        }
    }
}

TEST(LobeCurve, OfADiffuserIsFlat) {
    Material material;
    material.diffuse = {0.5, 0.5, 0.5};
    for (const LobePoint& point : lobe_curve(material, 0.7)) {
        EXPECT_NEAR(point.value.y, 0.5 / std::numbers::pi, 1e-12);
    }
}

/// What the widths in the docs promise: no lobe falls between two points of the curve.
TEST(LobeCurve, MeetsThePeakOfEveryLobe) {
    for (const double alpha : {1e-4, 1e-3, 0.02, 0.3}) {
        for (const double light : {0.1, 0.8, 1.3}) {
            const auto curve = lobe_curve(ggx(alpha), light);
            const glm::dvec3 wi(-std::sin(light), 0.0, std::cos(light));
            const auto most =
                std::max_element(curve.begin(), curve.end(), [](const auto& a, const auto& b) {
                    return a.value.x < b.value.x;
                });
            const glm::dvec3 mirror(-wi.x, 0.0, wi.z);
            const double peak =
                evaluate(ReflectanceModel::ggx, parameters_of_f64(ggx(alpha)), wi, mirror).x;
            EXPECT_GE(most->value.x, peak) << alpha << ' ' << light;
            // Half of the peak, somewhere below it: the flank has points as well.
            const auto flank = std::count_if(curve.begin(), curve.end(), [&](const auto& point) {
                return point.value.x > 0.2 * peak && point.value.x < 0.8 * peak;
            });
            EXPECT_GE(flank, 4) << alpha << ' ' << light;
        }
    }
}

}  // namespace
}  // namespace livery
