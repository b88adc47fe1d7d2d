// What a surface may do with light: never more out than in, the same both ways, finite always.
#include <cmath>
#include <cstdio>
#include <numbers>

#include <gtest/gtest.h>

#include "appearance/bsdf.h"
#include "appearance/models.h"
#include "core/random.h"
#include "core/worst_error.h"

namespace livery {
namespace {

TEST(DirectionalAlbedo, GgxOfAlphaOneAndF0OneAtNormalIncidenceIsOneMinusLogTwo) {
    f64::BsdfParameters p = plain_parameters();
    p.f0 = glm::dvec3(1.0);
    p.alpha_x = p.alpha_y = 1.0;
    const double albedo = directional_albedo(ReflectanceModel::ggx, p, {0.0, 0.0, 1.0}, 400).x;
    // Quadrature of 400 x 400 points: 1e-5 measured when doubling them.
    EXPECT_NEAR(albedo, 1.0 - std::numbers::ln2, 3e-5);
}

class Energy : public ::testing::TestWithParam<ReflectanceModel> {};

TEST_P(Energy, NeverExceedsOneWhereItIsClaimed) {
    const ModelInfo& model = model_info(GetParam());
    const WorstAlbedo worst = worst_albedo(GetParam(), 48);
    std::printf("    %-24s worst albedo %.5f: alpha %g, f0 or specular %g, cosine %g\n",
                model.name,
                worst.albedo,
                worst.alpha,
                worst.reflectance,
                worst.mu);
    if (model.conserves_energy) {
        EXPECT_LE(worst.albedo, 1.0 + 1e-4);
    } else {
        EXPECT_GT(worst.albedo, 1.01) << "it might claim that it conserves energy";
    }
}

/// Share of even light that leaves along wo: a sum over slopes of half vectors, even in their
/// logarithm and their azimuth. It knows no lobe, and nothing of how the models sample theirs.
glm::dvec3 albedo_by_slopes(ReflectanceModel model,
                            const f64::BsdfParameters& p,
                            const glm::dvec3& wo) {
    constexpr int kRings = 200, kAround = 64;
    constexpr double kFirst = -11.5, kLast = 6.0;
    constexpr double kStep = (kLast - kFirst) / kRings;
    constexpr double kTurn = 2.0 * std::numbers::pi / kAround;
    glm::dvec3 sum(0.0);
    for (int ring = 0; ring < kRings; ++ring) {
        const double slope = std::exp(kFirst + (ring + 0.5) * kStep);
        for (int k = 0; k < kAround; ++k) {
            // Half a step further from ring to ring, so that an edge does not meet many at once
            const double phi = kTurn * (k + 0.25 + 0.5 * (ring % 2));
            const glm::dvec3 h =
                glm::normalize(glm::dvec3(slope * std::cos(phi), slope * std::sin(phi), 1.0));
            const double c = glm::dot(wo, h);
            const glm::dvec3 wi = 2.0 * c * h - wo;
            if (c <= 0.0 || wi.z <= 0.0) continue;
            // Of the half vector slope^2 cos^3, of the light four times c as much
            const double solid_angle = 4.0 * c * slope * slope * std::pow(h.z, 3) * kStep * kTurn;
            sum += evaluate(model, p, wi, wo) * (wi.z * solid_angle);
        }
    }
    return sum;
}

/// All that a model's weights say of even light.
double weighed(ReflectanceModel model, const f64::BsdfParameters& p, double mu) {
    const f32::BsdfEnvironment e = environment_weights(model, rounded(p), static_cast<float>(mu));
    return static_cast<double>(e.diffuse.x) + static_cast<double>(e.specular.x) +
           static_cast<double>(e.coat.x);
}

/// Weights over what they should be, less 1.
struct WeightError {
    double worst = 0.0, sum = 0.0;
    int count = 0;

    void add(double weight, double truth) {
        const double error = weight / truth - 1.0;
        worst = worse_of(worst, std::abs(error));
        sum += error;
        ++count;
    }
    double mean() const { return count ? sum / count : 0.0; }
};

TEST_P(Energy, LightFromAllAroundIsWeightedByTheAlbedo) {
    // Relative, of the lobes and of the layer under them. Fits give the worst; their mean says
    // whether a whole weight is off. Lobes of f0 .04 by their difference, two under a coat: the fit
    // of a dielectric's albedo may be .009 too large (microfacet.glsl), ten times 2% of it.
    // Ashikhmin and Shirley's twelve by twelve directions are few for a wide lobe that the horizon
    // cuts.
    const double worst = GetParam() == ReflectanceModel::ashikhmin_shirley ? 0.06 : 0.03;
    WeightError lobes, layer;
    double faint = 0.0;
    for (const double alpha : {0.05, 0.1, 0.25, 0.5}) {
        for (const double mu : {0.1, 0.3, 0.6, 0.9, 1.0}) {
            for (const double f0 : {0.04, 0.4}) {
                f64::BsdfParameters p = plain_parameters();
                p.diffuse = glm::dvec3(0.3);
                p.specular = p.f0 = glm::dvec3(f0);
                set_slopes(p, alpha, alpha);
                const glm::dvec3 wo = direction(mu, 0.0);
                const double both = albedo_by_slopes(GetParam(), p, wo).x;
                const double all = weighed(GetParam(), p, mu);
                p.diffuse = glm::dvec3(0.0);
                const double mirrored = albedo_by_slopes(GetParam(), p, wo).x;
                const double mirror = weighed(GetParam(), p, mu);
                if (f0 < 0.1) {
                    faint = worse_of(faint, std::abs(mirror - mirrored));
                } else if (mirrored > 0.0) {
                    lobes.add(mirror, mirrored);
                }
                layer.add(all - mirror, both - mirrored);
            }
        }
    }
    std::printf(
        "    %-24s lobes %.4f at worst, %+.4f in the mean, faint ones %.4f; layer %.4f, %+.4f\n",
        model_info(GetParam()).name,
        lobes.worst,
        lobes.mean(),
        faint,
        layer.worst,
        layer.mean());
    EXPECT_LT(lobes.worst, worst);
    // No fit of a Fresnel term is in flakes.
    EXPECT_LT(std::abs(lobes.mean()), GetParam() == ReflectanceModel::car_paint ? 0.005 : 0.01);
    EXPECT_LT(faint, 0.019);
    EXPECT_LT(layer.worst, 0.03);
    EXPECT_LT(std::abs(layer.mean()), 0.015);
}

INSTANTIATE_TEST_SUITE_P(Models, Energy, ::testing::ValuesIn(all_models()), prefix_of);

TEST(DirectionalAlbedo, StaysWithinOneForStretchedLobes) {
    for (const double alpha : {1e-3, 0.05, 0.3}) {
        for (const double stretch : {1.3, 2.0, 3.3}) {
            for (const double mu : {0.02, 0.2, 0.7}) {
                for (const double phi : {0.0, 0.8, 1.57}) {
                    f64::BsdfParameters p = plain_parameters();
                    p.diffuse = glm::dvec3(1.0);
                    p.alpha_x = alpha;
                    p.alpha_y = alpha * stretch;
                    const glm::dvec3 wo = direction(mu, phi);
                    EXPECT_LE(directional_albedo(ReflectanceModel::ggx, p, wo, 64).x, 1.0 + 1e-4)
                        << "alpha " << alpha << " x " << stretch << " mu " << mu << " phi " << phi;
                }
            }
        }
    }
}

TEST(DirectionalAlbedo, WhiteLayersLoseLittle) {
    // What the bounds of the interface's albedo give away: at most 2%.
    for (const double alpha : {1e-3, 0.02, 0.1, 0.3, 0.6, 1.0}) {
        for (const double mu : {0.05, 0.2, 0.5, 1.0}) {
            f64::BsdfParameters p = plain_parameters();
            p.diffuse = glm::dvec3(1.0);
            p.alpha_x = p.alpha_y = alpha;
            EXPECT_GE(directional_albedo(ReflectanceModel::ggx, p, direction(mu, 0.0), 64).x, 0.98)
                << "alpha " << alpha << " mu " << mu;
            p.f0 = glm::dvec3(0.0);
            p.coat_alpha = alpha;
            EXPECT_GE(directional_albedo(ReflectanceModel::clearcoat, p, direction(mu, 0.0), 64).x,
                      0.98)
                << "coat " << alpha << " mu " << mu;
        }
    }
}

// The fits may err by .8% in what the coat transmits at cosines of .15, by .3% in its path and by
// .7% in the base's albedo. 2% of the cosine for which it transmits are no more than that. The dark
// coat is for the path.
TEST(Environment, WhatABaseSendsThroughItsCoatIsTheMeanOverItsLobe) {
    for (const auto model : {ReflectanceModel::clearcoat, ReflectanceModel::car_paint}) {
        WeightError clear, dark;
        for (const double alpha : {0.03, 0.07, 0.15, 0.25, 0.35, 0.5}) {
            for (const double mu : {0.15, 0.25, 0.35, 0.5, 0.7, 0.95}) {
                for (const double transmittance : {1.0, 0.7, 0.3}) {
                    f64::BsdfParameters p = plain_parameters();
                    p.diffuse = p.flake_f0 = glm::dvec3(0.0);
                    p.f0 = glm::dvec3(1.0);
                    p.alpha_x = p.alpha_y = alpha;
                    p.coat_transmittance = glm::dvec3(transmittance);
                    const double mean =
                        environment_weights(model, rounded(p), static_cast<float>(mu)).specular.x;
                    const double both = albedo_by_slopes(model, p, direction(mu, 0.0)).x;
                    p.f0 = glm::dvec3(0.0);
                    const double coat = albedo_by_slopes(model, p, direction(mu, 0.0)).x;
                    (transmittance < 0.5 ? dark : clear).add(mean, both - coat);
                }
            }
        }
        std::printf("    %-10s at most %.4f off; dark coats %.4f, %+.4f in the mean\n",
                    model_info(model).name,
                    clear.worst,
                    dark.worst,
                    dark.mean());
        EXPECT_LT(clear.worst, 0.018);
        EXPECT_LT(dark.worst, 0.03);
        EXPECT_LT(std::abs(dark.mean()), 0.015);
    }
}

TEST(Widening, AddsTheSlopeVariance) {
    f32::BsdfParameters p = rounded(plain_parameters());
    p.alpha_x = 0.3f;
    p.coat_alpha = 0.0001f;
    const f32::BsdfParameters wide = f32::bsdf_widen(p, 0.16f);
    EXPECT_NEAR(wide.alpha_x, 0.5f, 1e-6f);
    EXPECT_NEAR(wide.coat_alpha, 0.4f, 1e-6f);
    EXPECT_EQ(f32::bsdf_widen(p, 10.0f).alpha_y, 1.0f);
    EXPECT_EQ(f32::bsdf_widen(p, 0.0f).alpha_y, p.alpha_y);
}

}  // namespace
}  // namespace livery
