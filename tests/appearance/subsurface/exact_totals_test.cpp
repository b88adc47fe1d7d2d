// Boundaries and totals against closed forms and published figures.

#include "appearance/subsurface/exact_totals.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "appearance/subsurface/scattering_medium.h"
#include "core/quadrature.h"

namespace livery {
namespace {

TEST(FresnelMoments, AreThePublishedOnes) {
    struct {
        double eta, twice_c1, thrice_c2;
    } const rows[] = {
        {1.3, 0.444457, 0.300267}, {1.4, 0.528985, 0.388783}, {1.5, 0.596346, 0.464431}};
    for (const auto& row : rows) {
        const FresnelMoments moments = fresnel_moments(row.eta);
        EXPECT_NEAR(2.0 * moments.c1, row.twice_c1, 5e-7) << row.eta;
        EXPECT_NEAR(3.0 * moments.c2, row.thrice_c2, 5e-7) << row.eta;
        EXPECT_NEAR(moments.passed[0], 0.5 - moments.c1, 1e-9) << row.eta;
        EXPECT_NEAR(moments.passed[1], 1.0 / 3.0 - moments.c2, 1e-9) << row.eta;
    }
}

TEST(FresnelMoments, AreNothingWithoutABoundary) {
    const FresnelMoments moments = fresnel_moments(1.0);
    EXPECT_NEAR(moments.c1, 0.0, 1e-15);
    EXPECT_NEAR(moments.c2, 0.0, 1e-15);
    EXPECT_NEAR(moments.passed[2], 0.125, 1e-12);  // int mu P_2
    EXPECT_NEAR(moments.passed[3], 0.0, 1e-12);    // int mu P_3
}

TEST(FresnelMoments, FollowTheBruteIntegralForEveryIndex) {
    for (const double eta : {0.5, 0.8, 0.999999, 1.000001, 1.1, 2.0, 4.0}) {
        double c1 = 0.0, c2 = 0.0;
        constexpr int kSteps = 400'000;
        for (int k = 0; k < kSteps; ++k) {
            const double mu = (k + 0.5) / kSteps;
            const double f = inner_reflectance(eta, mu);
            ASSERT_GE(f, 0.0) << eta << " " << mu;
            ASSERT_LE(f, 1.0) << eta << " " << mu;
            c1 += f * mu / kSteps;
            c2 += f * mu * mu / kSteps;
        }
        const FresnelMoments moments = fresnel_moments(eta);
        EXPECT_NEAR(moments.c1, c1, 2e-6) << eta;
        EXPECT_NEAR(moments.c2, c2, 2e-6) << eta;
    }
}

/// Chandrasekhar's H for isotropic scattering, by iterating its integral equation
///   1/H(mu) = sqrt(1 - w) + w/2 int x H(x)/(x + mu) dx.
double chandrasekhar_h(double albedo, double mu) {
    const auto nodes = gauss_legendre(64);
    std::vector<double> h(nodes.size(), 1.0);
    const auto inverse = [&](double at) {
        double sum = 0.0;
        for (std::size_t k = 0; k < nodes.size(); ++k) {
            sum += nodes[k].weight * nodes[k].at * h[k] / (nodes[k].at + at);
        }
        return std::sqrt(1.0 - albedo) + 0.5 * albedo * sum;
    };
    for (int round = 0; round < 3000; ++round) {
        // Halfway: whole steps swing to and fro where nothing is absorbed.
        std::vector<double> next;
        for (std::size_t k = 0; k < nodes.size(); ++k) {
            next.push_back(0.5 * (h[k] + 1.0 / inverse(nodes[k].at)));
        }
        h = std::move(next);
    }
    return 1.0 / inverse(mu);
}

TEST(ExactTotals, AreChandrasekharsWithoutABoundary) {
    EXPECT_NEAR(chandrasekhar_h(1.0, 1.0), 2.90781, 2e-4);
    for (const double albedo : {0.05, 0.3, 0.5, 0.838, 0.98, 0.99844, 0.9999}) {
        const double exact = 1.0 - chandrasekhar_h(albedo, 1.0) * std::sqrt(1.0 - albedo);
        const ScatteringMedium medium{1.0 - albedo, albedo, 0.0, 1.0, {}};
        EXPECT_NEAR(exact_totals(medium).reflectance, exact, 5e-6) << albedo;
    }
}

TEST(ExactTotals, AreThePublishedOnes) {
    // van de Hulst 1980: what comes through holds what never scattered.
    const ScatteringMedium slab{1.0, 9.0, 0.75, 1.0, 0.2};
    const DiffuseTotals hulst = exact_totals(slab);
    EXPECT_NEAR(hulst.reflectance, 0.09739, 1e-5);
    EXPECT_NEAR(hulst.transmittance + unscattered_light(slab).transmitted, 0.66096, 1e-5);
    // Giovanelli 1955: of what arrives, with the 4% of the surface.
    const ScatteringMedium half_space{1.0, 9.0, 0.0, 1.5, {}};
    const double specular = unscattered_light(half_space).specular;
    EXPECT_NEAR(specular, 0.04, 1e-12);
    EXPECT_NEAR(specular + (1.0 - specular) * exact_totals(half_space).reflectance, 0.2600, 1e-4);
}

TEST(ExactTotals, AreThoseOfAnIndependentPhotonCode) {
    // MCML, 4 to 10 million photons, standard errors 6e-5 to 1.6e-4; per unit power that arrives.
    struct {
        ScatteringMedium medium;
        double reflected, through;
    } const rows[] = {
        {{0.0041, 2.62, 0.0, 1.0, {}}, 0.8923045, 0.0},
        {{0.0041, 2.62, 0.0, 1.5, {}}, 0.7674134, 0.0},
        {{0.17, 0.88, 0.0, 1.3, {}}, 0.2096399, 0.0},
        {{0.0041, 2.62, 0.0, 1.0, 2.0}, 0.7377076, 0.2442762},
        {{0.0041, 2.62, 0.0, 1.5, 2.0}, 0.6064491, 0.3158098},
        {{0.17, 0.88, 0.0, 1.3, 2.0}, 0.2010740, 0.2527786},
    };
    for (const auto& row : rows) {
        const UnscatteredLight light = unscattered_light(row.medium);
        const DiffuseTotals totals = exact_totals(row.medium);
        const double entering = 1.0 - light.specular;
        EXPECT_NEAR(entering * (totals.reflectance + light.reflected), row.reflected, 4.5e-4);
        EXPECT_NEAR(entering * (totals.transmittance + light.transmitted), row.through, 4.5e-4);
    }
}

TEST(ExactTotals, LoseNothingWhereNothingIsAbsorbed) {
    for (const double eta : {0.7, 1.0, 1.3, 2.0}) {
        for (const double g : {-0.7, 0.0, 0.5, 0.9, 0.99}) {
            for (const double depth : {1e-4, 1e-2, 1.0, 30.0, 3000.0}) {
                const ScatteringMedium medium{0.0, 1.0, g, eta, depth};
                const DiffuseTotals totals = exact_totals(medium);
                const UnscatteredLight light = unscattered_light(medium);
                const double all =
                    totals.reflectance + totals.transmittance + light.reflected + light.transmitted;
                EXPECT_NEAR(all, 1.0, 1e-6) << eta << " " << g << " " << depth;
            }
        }
    }
}

TEST(ExactTotals, StayWithinZeroAndOneInHardCases) {
    for (const double albedo : {0.0, 1e-9, 0.5, 0.9999, 1.0 - 1e-9, 1.0}) {
        for (const double depth : {1e-9, 1e-3, 1.0, 1e6}) {
            for (const double g : {0.0, -0.999, 0.999}) {
                const ScatteringMedium medium{1.0 - albedo, albedo, g, 1.5, depth};
                const DiffuseTotals totals = exact_totals(medium);
                ASSERT_GE(totals.reflectance, 0.0) << albedo << " " << depth;
                ASSERT_GE(totals.transmittance, 0.0) << albedo << " " << depth;
                ASSERT_LE(totals.reflectance + totals.transmittance, 1.0 + 1e-6)
                    << albedo << " " << depth << " " << g;
            }
        }
    }
    EXPECT_EQ(exact_totals({0.0, 0.0, 0.0, 1.5, {}}).reflectance, 0.0);
    EXPECT_EQ(exact_totals({0.0, 1.0, 0.0, 1.5, {}}).reflectance, 1.0);
}

TEST(Medium, IsRefusedOutOfRange) {
    const double nan = std::nan("");
    for (const ScatteringMedium& medium :
         std::vector<ScatteringMedium>{{-1.0, 1.0, 0.0, 1.5, {}},
                                       {nan, 1.0, 0.0, 1.5, {}},
                                       {1.0, 1e7, 0.0, 1.5, {}},
                                       {1.0, 1.0, 1.0, 1.5, {}},
                                       {1.0, 1.0, nan, 1.5, {}},
                                       {1.0, 1.0, 0.0, 0.4, {}},
                                       {1.0, 1.0, 0.0, 5.0, {}},
                                       {1.0, 1.0, 0.0, 1.5, 0.0},
                                       {1.0, 1.0, 0.0, 1.5, nan}}) {
        EXPECT_THROW(check_medium(medium), std::invalid_argument);
        EXPECT_THROW(exact_totals(medium), std::invalid_argument);
    }
}

}  // namespace
}  // namespace livery
