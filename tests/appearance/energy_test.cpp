// What a surface may do with light: never more out than in, the same both ways, finite always.
#include <cmath>
#include <cstdio>
#include <numbers>

#include <gtest/gtest.h>

#include "appearance/bsdf.h"
#include "appearance/models.h"
#include "core/random.h"

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

class Energy : public testing::TestWithParam<ReflectanceModel> {};

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

TEST_P(Energy, LightFromAllAroundIsWeightedByTheAlbedo) {
    double worst = 0.0;
    for (const double alpha : {0.05, 0.1, 0.25, 0.5}) {
        for (const double mu : {0.1, 0.3, 0.6, 0.9, 1.0}) {
            f64::BsdfParameters p = plain_parameters();
            p.diffuse = glm::dvec3(0.3);
            p.specular = p.f0 = glm::dvec3(0.4);
            set_slopes(p, alpha, alpha);
            const f32::BsdfEnvironment e =
                environment_weights(GetParam(), rounded(p), static_cast<float>(mu));
            const double sum = static_cast<double>(e.diffuse.x + e.specular.x + e.coat.x);
            const double albedo = directional_albedo(GetParam(), p, direction(mu, 0.0), 64).x;
            worst = std::max(worst, std::abs(sum - albedo));
        }
    }
    std::printf("    %-24s worst difference %.4f\n", model_info(GetParam()).name, worst);
    EXPECT_LT(worst, 0.03);
}

INSTANTIATE_TEST_SUITE_P(Models, Energy, testing::ValuesIn(all_models()), prefix_of);

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

TEST(Environment, WeightsAddUpToTheAlbedo) {
    // Uniform light: the weights must give the directional albedo. The interface's albedo is within
    // 0.017; under a coat light comes in along other directions than the mirror one for rough
    // bases.
    double worst_ggx = 0.0, worst_coat = 0.0;
    for (const double alpha : {0.02, 0.1, 0.25, 0.5}) {
        for (const double mu : {0.1, 0.3, 0.6, 0.9, 1.0}) {
            for (const double f0 : {0.04, 0.6}) {
                f64::BsdfParameters p = plain_parameters();
                p.diffuse = glm::dvec3(0.3);
                p.f0 = glm::dvec3(f0);
                p.alpha_x = p.alpha_y = alpha;
                p.coat_transmittance = glm::dvec3(0.9);
                for (const auto model : {ReflectanceModel::ggx, ReflectanceModel::clearcoat}) {
                    const f32::BsdfEnvironment e =
                        environment_weights(model, rounded(p), static_cast<float>(mu));
                    const double sum = static_cast<double>(e.diffuse.x + e.specular.x + e.coat.x);
                    const double albedo = directional_albedo(model, p, direction(mu, 0.0), 64).x;
                    double& worst = model == ReflectanceModel::ggx ? worst_ggx : worst_coat;
                    worst = std::max(worst, std::abs(sum - albedo));
                }
            }
        }
    }
    RecordProperty("worst_ggx", std::to_string(worst_ggx));
    RecordProperty("worst_clearcoat", std::to_string(worst_coat));
    EXPECT_LT(worst_ggx, 0.02);
    EXPECT_LT(worst_coat, 0.03);
}

// The fits may err by .8% in what the coat transmits at cosines of .15, by .3% in its path and by
// .7% in the base's albedo.
TEST(Environment, WhatABaseSendsThroughItsCoatIsTheMeanOverItsLobe) {
    for (const auto model : {ReflectanceModel::clearcoat, ReflectanceModel::car_paint}) {
        double worst = 0.0;
        for (const double alpha : {0.03, 0.07, 0.15, 0.25, 0.35, 0.5}) {
            for (const double mu : {0.15, 0.25, 0.35, 0.5, 0.7, 0.95}) {
                for (const double transmittance : {1.0, 0.7}) {
                    f64::BsdfParameters p = plain_parameters();
                    p.diffuse = p.flake_f0 = glm::dvec3(0.0);
                    p.f0 = glm::dvec3(1.0);
                    p.alpha_x = p.alpha_y = alpha;
                    p.coat_transmittance = glm::dvec3(transmittance);
                    const double mean =
                        environment_weights(model, rounded(p), static_cast<float>(mu)).specular.x;
                    const double both = directional_albedo(model, p, direction(mu, 0.0), 128).x;
                    p.f0 = glm::dvec3(0.0);
                    const double coat = directional_albedo(model, p, direction(mu, 0.0), 128).x;
                    worst = std::max(worst, std::abs(mean / (both - coat) - 1.0));
                }
            }
        }
        std::printf("    %-10s at most %.4f off\n", model_info(model).name, worst);
        EXPECT_LT(worst, 0.018);
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
