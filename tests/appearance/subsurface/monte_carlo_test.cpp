// The photon walk against closed forms, published figures and an independent photon code's tables.

#include "appearance/subsurface/monte_carlo.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "appearance/subsurface/exact_totals.h"
#include "appearance/subsurface/media.h"
#include "core/error.h"
#include "core/parallel.h"
#include "subsurface_reference.h"
#include "support/reference_data.h"

namespace livery {
namespace {

constexpr std::uint64_t kPhotonSeed = 4;

TEST(MonteCarlo, IsWithinItsErrorOfExactTotals) {
    std::printf("seed %d\n", static_cast<int>(kPhotonSeed));
    for (const ScatteringMedium& medium : {ScatteringMedium{1.0, 9.0, 0.75, 1.0, 0.2},
                                           ScatteringMedium{1.0, 9.0, 0.0, 1.5, {}},
                                           ScatteringMedium{0.17, 0.88, 0.0, 1.0, {}},
                                           ScatteringMedium{0.17, 0.88, 0.0, 1.3, 2.0},
                                           ScatteringMedium{0.5, 0.5, -0.5, 1.4, 1.0},
                                           ScatteringMedium{0.05, 4.0, 0.9, 1.5, 1.0},
                                           ScatteringMedium{0.1, 1.0, 0.0, 0.8, 1.0}}) {
        const MonteCarloProfile profile = monte_carlo_profile(medium, {}, {100'000, kPhotonSeed});
        const DiffuseTotals exact = exact_totals(medium);
        const auto near = [&](const Estimate& estimate, double value) {
            EXPECT_NEAR(estimate.value, value, 3.5 * estimate.standard_error + 2e-4)
                << medium.sigma_a_per_mm << " " << medium.sigma_s_per_mm << " " << medium.eta;
        };
        near(profile.total_reflectance, exact.reflectance);
        near(profile.total_transmittance, exact.transmittance);
        EXPECT_NEAR(sum_of(profile), 1.0, 1e-9);
        const UnscatteredLight light = unscattered_light(medium);
        EXPECT_NEAR(profile.unscattered_transmittance, light.transmitted, 6e-3);
    }
}

TEST(MonteCarlo, LosesNothingInHardCases) {
    for (const ScatteringMedium& medium : {ScatteringMedium{0.0, 1.0, 0.0, 1.0, {}},
                                           ScatteringMedium{0.0001, 0.9999, 0.0, 1.5, {}},
                                           ScatteringMedium{0.0, 1.0, 0.0, 1.5, 1e-3},
                                           ScatteringMedium{0.01, 100.0, 0.99, 1.3, 0.05},
                                           ScatteringMedium{1.0, 0.0, 0.0, 1.5, 0.3},
                                           ScatteringMedium{0.0, 0.0, 0.0, 1.5, 0.3}}) {
        const MonteCarloProfile profile =
            monte_carlo_profile(medium, {{0.0, 1.0}, {1.0, 5.0}}, {2000, kPhotonSeed});
        EXPECT_NEAR(sum_of(profile), 1.0, 1e-9) << medium.sigma_s_per_mm;
        for (const auto& rings : {profile.rd, profile.rt}) {
            for (const Estimate& ring : rings) {
                EXPECT_TRUE(std::isfinite(ring.value) && ring.value >= 0.0);
                EXPECT_TRUE(std::isfinite(ring.standard_error));
            }
        }
    }
    const auto conservative =
        monte_carlo_profile({0.0, 1.0, 0.0, 1.0, {}}, {}, {2000, kPhotonSeed});
    EXPECT_NEAR(conservative.total_reflectance.value, 1.0, 1e-9);
}

TEST(MonteCarlo, IsTheSameOnAnyNumberOfThreads) {
    const ScatteringMedium medium{0.17, 0.88, 0.5, 1.3, 2.0};
    const std::vector<ProfileRing> rings{{0.0, 0.3}, {0.2, 1.0}, {0.5, 2.0}};
    const auto values = [&](int threads, std::uint64_t seed) {
        set_thread_count(threads);
        const MonteCarloProfile profile = monte_carlo_profile(medium, rings, {6400, seed});
        set_thread_count(0);
        std::vector<double> all{profile.total_reflectance.value, profile.absorbed.value};
        for (const Estimate& ring : profile.rd) all.push_back(ring.value);
        for (const Estimate& ring : profile.rt) all.push_back(ring.standard_error);
        return all;
    };
    EXPECT_EQ(values(1, 1), values(3, 1));
    EXPECT_NE(values(1, 1), values(1, 2));
}

TEST(MonteCarlo, OverlappingRingsAreWhatTheyAreAlone) {
    const ScatteringMedium medium{0.17, 0.88, 0.0, 1.3, {}};
    const MonteCarloSettings settings{6400, kPhotonSeed};
    const ProfileRing wide{0.2, 2.0}, narrow{0.5, 1.0};
    const auto both = monte_carlo_profile(medium, {wide, narrow}, settings);
    EXPECT_NEAR(both.rd[0].value, monte_carlo_profile(medium, {wide}, settings).rd[0].value, 1e-12);
    EXPECT_NEAR(
        both.rd[1].value, monte_carlo_profile(medium, {narrow}, settings).rd[0].value, 1e-12);
    // All rings together are all that comes back.
    const auto whole = monte_carlo_profile(medium, {{0.0, 1e4}}, settings);
    const double power = whole.rd[0].value * std::numbers::pi * 1e8;
    EXPECT_NEAR(power, exact_totals(medium).reflectance, 0.02);
}

TEST(MonteCarlo, RefusesWhatItCannotDo) {
    EXPECT_THROW(monte_carlo_profile({1.0, 1.0, 0.0, 1.5, {}}, {}, {10, 1}), std::invalid_argument);
    EXPECT_THROW(monte_carlo_profile({1.0, 1.0, 0.0, 1.5, {}}, {{1.0, 1.0}}, {1000, 1}),
                 std::invalid_argument);
    const std::atomic<bool> stop{true};
    EXPECT_THROW(monte_carlo_profile({1.0, 1.0, 0.0, 1.5, {}}, {}, {1000, 1}, {{}, &stop}),
                 Cancelled);
}

TEST(MonteCarlo, FollowsTheTablesOfAnIndependentPhotonCode) {
    LIVERY_NEEDS_REFERENCE_DATA(data);
    for (const ReferenceTable& table : reference_tables(data)) {
        const bool slow = table.medium.sigma_a_per_mm < 0.1 && !table.medium.thickness_mm;
        const auto profile =
            monte_carlo_profile(table.medium, table.rings, {slow ? 20'000u : 60'000u, kPhotonSeed});
        const auto chi_square = [&](const auto& ours, const auto& theirs) {
            double sum = 0.0;
            int count = 0;
            // The first ring holds what never scattered.
            for (std::size_t k = 1; k < ours.size(); ++k) {
                const Estimate &a = ours[k], &b = theirs[k];
                if (!(a.standard_error < 0.05 * a.value && b.standard_error < 0.05 * b.value)) {
                    continue;
                }
                const double off = a.value - b.value;
                sum += off * off /
                       (a.standard_error * a.standard_error + b.standard_error * b.standard_error);
                ++count;
            }
            EXPECT_GT(count, 20) << table.name;
            return sum / count;
        };
        const double up = chi_square(profile.rd, table.rd);
        std::printf("%s: reduced chi-square %.2f\n", table.name.c_str(), up);
        EXPECT_GT(up, 0.6) << table.name;
        EXPECT_LT(up, 1.5) << table.name;
        if (!table.medium.thickness_mm) continue;
        const double down = chi_square(profile.rt, table.rt);
        EXPECT_GT(down, 0.6) << table.name;
        EXPECT_LT(down, 1.5) << table.name;
    }
}

}  // namespace
}  // namespace livery
