// Measured reflectance as a paint: its samples, and what it does to light from all around.
#include "appearance/measured/measured_paint.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "appearance/bsdf.h"
#include "appearance/merl_bytes.h"
#include "appearance/models.h"
#include "core/colour.h"

namespace livery {
namespace {

glm::dvec3 glossy(const glm::dvec3& wi, const glm::dvec3& wo) {
    f64::BsdfParameters p = plain_parameters();
    p.diffuse = {0.3, 0.1, 0.05};
    p.f0 = glm::dvec3(0.2);
    p.alpha_x = p.alpha_y = 0.15;
    return evaluate(ReflectanceModel::ggx, p, wi, wo);
}

const MeasuredReflectance& glossy_table() {
    static const MeasuredReflectance measured =
        measured_from(parse_merl(merl_bytes([](const glm::dvec3& wi, const glm::dvec3& wo) {
                                     return rec709_from_working() * glossy(wi, wo);
                                 }),
                                 "glossy.binary"),
                      "glossy.binary");
    return measured;
}

const MeasuredPaint& glossy_paint() {
    static const MeasuredPaint paint = measured_paint(glossy_table());
    return paint;
}

glm::vec3 random_point(Random& random) {
    return {random.uniform_float(), random.uniform_float(), random.uniform_float()};
}

TEST(MeasuredPaint, SamplesFallAsOftenAsTheirDensitySays) {
    constexpr int kRows = 12, kColumns = 16, kInside = 24, kSamples = 400'000;
    Random random(3);
    for (const double mu : {0.1, 0.5, 0.95}) {
        const glm::vec3 wo(direction(mu, 0.7));
        std::vector<double> expected(kRows * kColumns, 0.0), counts(kRows * kColumns, 0.0);
        for (int row = 0; row < kRows * kInside; ++row) {
            for (int column = 0; column < kColumns * kInside; ++column) {
                const glm::dvec3 wi =
                    direction((row + 0.5) / (kRows * kInside),
                              2.0 * std::numbers::pi * (column + 0.5) / (kColumns * kInside));
                const auto cell =
                    static_cast<std::size_t>(row / kInside * kColumns + column / kInside);
                expected[cell] += static_cast<double>(pdf(glossy_paint(), glm::vec3(wi), wo)) *
                                  2.0 * std::numbers::pi / (kRows * kInside * kColumns * kInside);
            }
        }
        double above = 0.0;
        for (int k = 0; k < kSamples; ++k) {
            const glm::vec3 wi = sample(glossy_paint(), wo, random_point(random));
            ASSERT_NEAR(static_cast<double>(glm::length(wi)), 1.0, 1e-5);
            if (wi.z <= 0.0f) continue;
            const double turn = std::atan2(static_cast<double>(wi.y), static_cast<double>(wi.x)) /
                                (2.0 * std::numbers::pi);
            const int column =
                std::min(static_cast<int>((turn - std::floor(turn)) * kColumns), kColumns - 1);
            const int row = std::min(static_cast<int>(wi.z * kRows), kRows - 1);
            counts[static_cast<std::size_t>(row * kColumns + column)] += 1.0;
            above += 1.0;
        }
        double all = 0.0;
        for (std::size_t cell = 0; cell < counts.size(); ++cell) {
            const double mean = expected[cell] * kSamples;
            all += expected[cell];
            // Five standard deviations of the count, and what the integral of the density is off.
            EXPECT_NEAR(counts[cell], mean, 5.0 * std::sqrt(mean) + 0.02 * mean + 5.0)
                << mu << " cell " << cell;
        }
        EXPECT_NEAR(above / kSamples, all, 0.005) << mu;
    }
}

TEST(MeasuredPaint, SamplesIntegrateToTheAlbedoWithLittleNoise) {
    Random random(4);
    for (const double mu : {0.2, 0.6, 1.0}) {
        const glm::dvec3 wo = direction(mu, 0.0);
        const double albedo = directional_albedo(glossy_table(), wo).y;
        double sum = 0.0, squares = 0.0;
        constexpr int kSamples = 100'000;
        for (int k = 0; k < kSamples; ++k) {
            const glm::vec3 wi = sample(glossy_paint(), glm::vec3(wo), random_point(random));
            const float density = pdf(glossy_paint(), wi, glm::vec3(wo));
            const double share =
                density > 0.0f ? static_cast<double>(evaluate(glossy_paint(), wi, glm::vec3(wo)).y *
                                                     wi.z / density)
                               : 0.0;
            sum += share / kSamples;
            squares += share * share / kSamples;
        }
        const double deviation = std::sqrt(squares - sum * sum);
        EXPECT_NEAR(sum, albedo, 4.0 * deviation / std::sqrt(kSamples) + 0.005 * albedo) << mu;
        EXPECT_LT(deviation, 1.5 * albedo) << mu;
    }
}

TEST(MeasuredPaint, UniformLightGivesTheAlbedo) {
    for (const double mu : {0.05, 0.3, 0.77, 1.0}) {
        const glm::dvec3 albedo = directional_albedo(glossy_table(), direction(mu, 0.0));
        const f32::BsdfEnvironment e = environment_weights(glossy_paint(), static_cast<float>(mu));
        for (int c = 0; c < 3; ++c) {
            EXPECT_NEAR(static_cast<double>(e.diffuse[c] + e.specular[c]), albedo[c], 0.01) << mu;
            EXPECT_GE(e.diffuse[c], 0.0f);
            EXPECT_GE(e.specular[c], 0.0f);
        }
        EXPECT_GT(e.diffuse.x, 2.0f * e.diffuse.y) << "the colour lies below the lobe";
        EXPECT_NEAR(e.specular.x, e.specular.y, 0.2f * e.specular.x) << "which has none";
    }
}

TEST(MeasuredPaint, KnowsHowWideItsLobeIs) { EXPECT_NEAR(glossy_paint().lobe_alpha, 0.15f, 0.03f); }

TEST(MeasuredPaint, IsDefinedWhereNothingIsReflected) {
    MeasuredSamples black;
    for (int k = 0; k < 20; ++k) {
        black.pairs.push_back({direction(0.05 * (k + 1), 0.0), direction(0.5, k)});
        black.values.insert(black.values.end(), {0.0, 0.0, 0.0});
    }
    const MeasuredPaint paint =
        measured_paint(measured_from(black, MeasuredFormat::csv, "black.csv"));
    Random random(5);
    for (int k = 0; k < 1000; ++k) {
        const glm::vec3 wo(random_direction(random));
        const glm::vec3 wi = sample(paint, wo, random_point(random));
        EXPECT_TRUE(std::isfinite(pdf(paint, wi, wo)));
        EXPECT_LT(evaluate(paint, wi, wo).y, 1e-6f);
    }
    EXPECT_LT(environment_weights(paint, 0.4f).diffuse.y, 1e-5f);
}

}  // namespace
}  // namespace livery
