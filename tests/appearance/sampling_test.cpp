// Samples fall as often as their density says.
#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "appearance/bsdf.h"
#include "appearance/models.h"
#include "core/random.h"

namespace livery {
namespace {

constexpr int kRows = 24, kColumns = 36, kInside = 10, kSamples = 200'000;

/// Nodes and weights of Gauss and Legendre on [0, 1].
struct Rule {
    std::vector<double> at, weight;
};
Rule gauss_legendre(int n) {
    Rule rule;
    for (int i = 0; i < n; ++i) {
        double x = std::cos(std::numbers::pi * (i + 0.75) / (n + 0.5)), slope = 0.0;
        for (int step = 0; step < 100; ++step) {
            double p0 = 1.0, p1 = x;
            for (int k = 2; k <= n; ++k) {
                const double p2 = ((2.0 * k - 1.0) * x * p1 - (k - 1.0) * p0) / k;
                p0 = p1;
                p1 = p2;
            }
            slope = n * (x * p1 - p0) / (x * x - 1.0);
            x -= p1 / slope;
        }
        rule.at.push_back(0.5 * (1.0 + x));
        rule.weight.push_back(1.0 / ((1.0 - x * x) * slope * slope));
    }
    return rule;
}

/// Integrals of the density over cells of equal steps in cosine and azimuth.
std::vector<double> expected_shares(ReflectanceModel model,
                                    const f64::BsdfParameters& p,
                                    const glm::dvec3& wo) {
    std::vector<double> shares;
    const Rule rule = gauss_legendre(kInside);
    for (int row = 0; row < kRows; ++row) {
        for (int column = 0; column < kColumns; ++column) {
            double sum = 0.0;
            for (std::size_t i = 0; i < rule.at.size(); ++i) {
                for (std::size_t j = 0; j < rule.at.size(); ++j) {
                    const double mu = (row + rule.at[i]) / kRows;
                    const double phi = 2.0 * std::numbers::pi * (column + rule.at[j]) / kColumns;
                    sum += rule.weight[i] * rule.weight[j] * pdf(model, p, direction(mu, phi), wo);
                }
            }
            shares.push_back(sum * 2.0 * std::numbers::pi / (kRows * kColumns));
        }
    }
    return shares;
}

class Sampling : public ::testing::TestWithParam<ReflectanceModel> {};

TEST_P(Sampling, ChiSquareAgainstTheDensity) {
    Random random(17);
    for (const double alpha : {0.1, 0.3, 1.0}) {
        for (const double mu : {0.05, 0.4, 0.95}) {
            f64::BsdfParameters p = plain_parameters();
            p.diffuse = glm::dvec3(0.4);
            p.f0 = glm::dvec3(0.5);
            p.specular = glm::dvec3(0.5);
            set_slopes(p, alpha, std::min(2.0 * alpha, 1.0));
            p.flake_f0 = glm::dvec3(1.0);
            p.coat_alpha = 0.12;
            const glm::dvec3 wo = direction(mu, 0.7);
            const std::vector<double> shares = expected_shares(GetParam(), p, wo);
            std::vector<int> counts(shares.size(), 0);
            for (int k = 0; k < kSamples; ++k) {
                const glm::dvec3 u(random.uniform(), random.uniform(), random.uniform());
                const glm::dvec3 wi = sample(GetParam(), p, wo, u);
                if (wi.z <= 0.0) continue;
                const double turn = std::atan2(wi.y, wi.x) / (2.0 * std::numbers::pi);
                const int column =
                    std::min(static_cast<int>((turn - std::floor(turn)) * kColumns), kColumns - 1);
                const int row = std::min(static_cast<int>(wi.z * kRows), kRows - 1);
                ++counts[static_cast<std::size_t>(row * kColumns + column)];
            }
            // Cells with few samples share one; the rest of the samples lie below the horizon.
            double chi2 = 0.0, pooled = 0.0, above = 0.0;
            int pooled_count = 0, cells = 0, above_count = 0;
            const auto add = [&](double expected, int count) {
                chi2 += (count - expected) * (count - expected) / expected;
                ++cells;
            };
            for (std::size_t i = 0; i < shares.size(); ++i) {
                const double expected = shares[i] * kSamples;
                above += expected;
                above_count += counts[i];
                if (expected >= 10.0) {
                    add(expected, counts[i]);
                } else {
                    pooled += expected;
                    pooled_count += counts[i];
                }
            }
            if (pooled >= 10.0) add(pooled, pooled_count);
            ASSERT_LE(above, kSamples * 1.001);
            if (kSamples - above >= 10.0) add(kSamples - above, kSamples - above_count);
            const double freedom = cells - 1;
            // Four standard deviations of the chi-square distribution.
            EXPECT_LT(chi2, freedom + 4.0 * std::sqrt(2.0 * freedom))
                << "alpha " << alpha << " mu " << mu << " cells " << cells;
        }
    }
}

TEST_P(Sampling, WeightsAverageToTheAlbedoForNarrowLobesToo) {
    Random random(23);
    for (const double alpha : {1e-4, 1e-3, 0.01, 0.2}) {
        for (const double mu : {0.02, 0.3, 0.9}) {
            f64::BsdfParameters p = plain_parameters();
            p.diffuse = glm::dvec3(0.4);
            p.f0 = glm::dvec3(0.3);
            p.specular = glm::dvec3(0.3);
            set_slopes(p, alpha, alpha);
            p.coat_alpha = 0.5 * alpha + 1e-4;
            const glm::dvec3 wo = direction(mu, 2.0);
            double sum = 0.0, squares = 0.0;
            constexpr int kCount = 40'000;
            for (int k = 0; k < kCount; ++k) {
                const glm::dvec3 u(random.uniform(), random.uniform(), random.uniform());
                const glm::dvec3 wi = sample(GetParam(), p, wo, u);
                if (wi.z <= 0.0) continue;
                const double weight =
                    evaluate(GetParam(), p, wi, wo).x * wi.z / pdf(GetParam(), p, wi, wo);
                sum += weight;
                squares += weight * weight;
            }
            const double mean = sum / kCount;
            const double error = std::sqrt((squares / kCount - mean * mean) / kCount);
            EXPECT_NEAR(mean, directional_albedo(GetParam(), p, wo).x, 4.0 * error + 1e-4)
                << "alpha " << alpha << " mu " << mu;
            EXPECT_LT(error, 0.01);
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Models, Sampling, ::testing::ValuesIn(all_models()), prefix_of);

}  // namespace
}  // namespace livery
