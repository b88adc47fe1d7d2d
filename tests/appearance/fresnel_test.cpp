// What coats and glass throw back is what Fresnel's equations say, not Schlick's approximation.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include <gtest/gtest.h>

#include "appearance/bsdf.h"
#include "appearance/models.h"
#include "appearance/paint_figures.h"
#include "core/worst_error.h"

namespace livery {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

double index_of(double f0) { return (1.0 + std::sqrt(f0)) / (1.0 - std::sqrt(f0)); }

/// F of a model's outermost lobe at mirror incidence: its value over the lobe's. Nothing may lie
/// below.
double reflectance_of(ReflectanceModel model, const f64::BsdfParameters& p, double theta_rad) {
    const glm::dvec3 wo = direction(std::cos(theta_rad), 0.3);
    const glm::dvec3 wi(-wo.x, -wo.y, wo.z);
    const double alpha =
        model == ReflectanceModel::clearcoat || model == ReflectanceModel::car_paint ? p.coat_alpha
                                                                                     : p.alpha_x;
    const double hh = 4.0 * wo.z * wo.z;
    return evaluate(model, p, wi, wo).x /
           f64::ggx_distribution_visibility(wi, wo, hh, alpha, alpha);
}

f64::BsdfParameters interface_of(double f0) {
    f64::BsdfParameters p = plain_parameters();
    set_slopes(p, 0.02, 0.02);
    p.coat_f0 = f0;
    p.f0 = glm::dvec3(f0);
    return p;
}

TEST(Fresnel, CoatsAndGlassThrowBackWhatFresnelSays) {
    // Schlick's approximation is 21 to 23% dark at 53 to 60 degrees for index 1.5.
    for (const double f0 : {0.02, 0.04, 0.08, 0.2}) {
        for (const double degrees : {0.0, 20.0, 53.0, 56.3, 60.0, 75.0, 85.0, 89.9}) {
            const double theta = degrees * kDegree;
            const double exact = dielectric_reflectance(std::cos(theta), index_of(f0));
            const f64::BsdfParameters glass = interface_of(f0);
            EXPECT_NEAR(reflectance_of(ReflectanceModel::ggx, glass, theta) / exact, 1.0, 1e-9)
                << "ggx, f0 " << f0 << ", " << degrees << " degrees";
            f64::BsdfParameters coat = glass;
            coat.f0 = coat.flake_f0 = glm::dvec3(0.0);
            for (const auto model : {ReflectanceModel::clearcoat, ReflectanceModel::car_paint}) {
                EXPECT_NEAR(reflectance_of(model, coat, theta) / exact, 1.0, 1e-9)
                    << model_info(model).name << ", f0 " << f0 << ", " << degrees << " degrees";
            }
        }
    }
}

TEST(Fresnel, MetalsKeepSchlicks) {
    for (const double f0 : {0.4, 0.7, 0.95}) {
        for (const double degrees : {0.0, 45.0, 75.0, 89.0}) {
            const double c = std::cos(degrees * kDegree);
            const double schlick = f0 + (1.0 - f0) * std::pow(1.0 - c, 5.0);
            const double value =
                reflectance_of(ReflectanceModel::ggx, interface_of(f0), degrees * kDegree);
            EXPECT_NEAR(value, schlick, 1e-9) << f0 << ", " << degrees;
        }
    }
}

TEST(Fresnel, GoesOverFromDielectricsToMetalsWithoutAStep) {
    for (const double degrees : {10.0, 56.0, 80.0}) {
        const double hh = 4.0 * std::pow(std::cos(degrees * kDegree), 2.0);
        double before = f64::fresnel_weight(f64::fresnel_prepare(0.02), hh);
        for (double f0 = 0.02; f0 <= 1.0; f0 += 1e-3) {
            const double weight = f64::fresnel_weight(f64::fresnel_prepare(f0), hh);
            EXPECT_NEAR(weight, before, 0.02) << f0 << ", " << degrees;
            EXPECT_GT(weight, -0.02) << "metal and dielectric alike hardly fall";
            before = weight;
        }
    }
}

TEST(Fresnel, KeepsItsDigitsInFloat) {
    // Against Snell's law in double precision, up to 89.99 degrees; 1 - F too, which is what is
    // left for the layers below. f0 and the cosine are float's in both.
    for (const float f0 : {0.0201f, 0.04f, 0.1f, 0.2f}) {
        for (const double degrees : {0.0, 1.0, 30.0, 56.3, 75.0, 88.0, 89.9, 89.99}) {
            const auto c = static_cast<float>(std::cos(degrees * kDegree));
            const double exact = dielectric_reflectance(c, index_of(f0));
            const double passed =
                static_cast<double>(f32::fresnel_rest(f32::fresnel_prepare(f0), c)) * (1.0 - f0);
            EXPECT_NEAR(passed / (1.0 - exact), 1.0, 2e-6) << f0 << ", " << degrees;
        }
    }
}

TEST(Fresnel, AlbedoOfACoatIsNeverTooSmall) {
    // What is left below a coat is one minus a fit of its albedo: too small an albedo would make
    // light. Both ends as told in microfacet.glsl: 1e-4, and 0.041 + 0.0066.
    double low = 0.0, high = 0.0;
    for (const double f0 : {0.02, 0.04, 0.1, 0.2}) {
        for (const double alpha : {0.003, 0.02, 0.06, 0.2, 0.5, 1.0}) {
            for (const double mu : {0.02, 0.06, 0.15, 0.4, 0.8, 1.0}) {
                f64::BsdfParameters p = interface_of(f0);
                set_slopes(p, alpha, alpha);
                p.coat_alpha = alpha;
                const double truth =
                    directional_albedo(ReflectanceModel::ggx, p, direction(mu, 0.0), 128).x;
                const double excess = f64::coat_albedo(f64::coat_prepare(p), mu, 1.0) - truth;
                low = std::min(low, excess);
                high = worse_of(high, excess);
            }
        }
    }
    std::printf("    albedo of a coat: %+.5f to %+.5f\n", low, high);
    EXPECT_GE(low, -1e-4);
    EXPECT_LE(high, 0.0476);
}

}  // namespace
}  // namespace livery
