// Owen-scrambled Sobol points: nets, independent seeds, and the error that they are for.
#include "reference/sobol.h"

#include <cmath>
#include <set>
#include <vector>

#include <glm/vec3.hpp>
#include <gtest/gtest.h>

#include "core/random.h"

namespace livery {
namespace {

TEST(Sobol, EachDimensionFillsEveryIntervalOfEveryAlignedBlockOnce) {
    for (const std::uint32_t seed : {0u, 1u, 0xdeadbeefu}) {
        for (const std::uint32_t count : {4u, 16u, 64u, 256u}) {
            for (const std::uint32_t block : {0u, 1u, 5u}) {
                for (std::uint32_t d = 0; d < SobolPoint::kDimensions; ++d) {
                    std::set<int> cells;
                    for (std::uint32_t k = 0; k < count; ++k) {
                        const float x = SobolPoint(block * count + k, seed)[d];
                        ASSERT_TRUE(x >= 0.0f && x < 1.0f);
                        cells.insert(static_cast<int>(x * static_cast<float>(count)));
                    }
                    EXPECT_EQ(cells.size(), count) << "seed " << seed << ", dimension " << d;
                }
            }
        }
    }
}

TEST(Sobol, TheFirstTwoDimensionsFillEveryRectangleOfTheirAreaOnce) {
    constexpr int kLog = 6, kCount = 1 << kLog;
    for (const std::uint32_t seed : {3u, 77u}) {
        for (int wide = 0; wide <= kLog; ++wide) {
            std::set<std::pair<int, int>> cells;
            for (std::uint32_t k = 0; k < kCount; ++k) {
                const glm::vec2 p = SobolPoint(k, seed).pair(0);
                cells.emplace(static_cast<int>(p.x * static_cast<float>(1 << wide)),
                              static_cast<int>(p.y * static_cast<float>(1 << (kLog - wide))));
            }
            EXPECT_EQ(cells.size(), static_cast<std::size_t>(kCount)) << "2^" << wide << " columns";
        }
    }
}

TEST(Sobol, OtherSeedsAreIndependentAndUnbiased) {
    // The mean over seeds of one point is uniform, and two seeds' same points are uncorrelated.
    constexpr int kSeeds = 20000;
    for (const std::uint32_t index : {0u, 1u, 37u}) {
        for (std::uint32_t d = 0; d < SobolPoint::kDimensions; ++d) {
            double sum = 0.0, squares = 0.0, beside = 0.0;
            for (std::uint32_t seed = 0; seed < kSeeds; ++seed) {
                const auto at = [&](std::uint32_t of_seed) {
                    const SobolPoint point(index, hash_3d(of_seed, 1, 2));
                    return static_cast<double>(point[d]) - 0.5;
                };
                const double x = at(seed);
                sum += x;
                squares += x * x;
                beside += x * at(seed + 1);
            }
            // Standard errors .289, .0745 and .0833 / sqrt(20000); five of them
            EXPECT_NEAR(sum / kSeeds, 0.0, 5 * 0.00204) << "dimension " << d;
            EXPECT_NEAR(squares / kSeeds, 1.0 / 12.0, 5 * 0.00053) << "dimension " << d;
            EXPECT_NEAR(beside / kSeeds, 0.0, 5 * 0.00059) << "dimension " << d;
        }
    }
}

/// Of 256 seeds, the mean squared error of the mean of `count` values of a function.
template <typename Function, typename Numbers>
double mean_squared_error(std::uint32_t count, double truth, Function f, Numbers numbers) {
    double sum = 0.0;
    for (std::uint32_t seed = 0; seed < 256; ++seed) {
        double mean = 0.0;
        for (std::uint32_t k = 0; k < count; ++k) mean += f(numbers(k, seed));
        mean = mean / count - truth;
        sum += mean * mean / 256;
    }
    return sum;
}

TEST(Sobol, TheErrorFallsFasterThanThatOfIndependentNumbers) {
    const auto scrambled = [](std::uint32_t k, std::uint32_t seed) {
        const SobolPoint point(k, hash_3d(seed, 3, 4));
        return glm::vec3(point.pair(0), point[2]);
    };
    const auto independent = [](std::uint32_t k, std::uint32_t seed) {
        Random random(hash_3d(k, seed, 9));
        const float x = random.uniform_float(), y = random.uniform_float();
        return glm::vec3(x, y, random.uniform_float());
    };
    const auto smooth = [](const glm::vec3& u) {
        return std::exp(static_cast<double>(u.x)) * std::cos(static_cast<double>(u.y));
    };
    const auto edge = [](const glm::vec3& u) {
        return u.x * u.x + u.y * u.y < 0.5f + 0.25f * u.z ? 1.0 : 0.0;
    };
    const double smooth_truth = (std::exp(1.0) - 1.0) * std::sin(1.0);
    // A quarter disc of squared radius .5 to .75: pi/4 of its mean, .625
    const double edge_truth = 0.25 * 3.14159265358979 * 0.625;
    // Variance per point falls as 1/n for numbers of no pattern; by two powers more for smooth
    // functions of two numbers (Owen 1997), by half of one at an edge. Asked for: a tenth of that.
    EXPECT_LT(mean_squared_error(256, smooth_truth, smooth, scrambled),
              mean_squared_error(256, smooth_truth, smooth, independent) / 1000.0);
    EXPECT_LT(mean_squared_error(256, edge_truth, edge, scrambled),
              mean_squared_error(256, edge_truth, edge, independent) / 4.0);
}

}  // namespace
}  // namespace livery
