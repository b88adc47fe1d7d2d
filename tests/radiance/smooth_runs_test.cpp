// Fragments whose values are taken from others: which, from which, and in which order.
#include "radiance/smooth_runs.h"

#include <array>
#include <cmath>
#include <cstdio>

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/random.h"

namespace livery {
namespace {

constexpr int kWidth = 61, kHeight = 37;

/// A plane of pixels, some of which are another part's, not whole, or missing, and a fold in it.
SurfaceMap torn_map(std::uint64_t seed) {
    Random random(seed);
    SurfaceMap map;
    map.width = kWidth;
    map.height = kHeight;
    for (std::uint16_t part = 0; part < 2; ++part) {
        for (std::uint32_t pixel = 0; pixel < kWidth * kHeight; ++pixel) {
            const int x = static_cast<int>(pixel) % kWidth, y = static_cast<int>(pixel) / kWidth;
            const bool own = ((x / 17 + y / 11) % 3 == 0) == (part == 1);
            if (!own || random.uniform() < 0.01) continue;
            Fragment& f = map.fragments.emplace_back();
            f.pixel = pixel;
            f.part = part;
            f.coverage = random.uniform() < 0.01 ? 0.7f : 1.0f;
            const auto tilt = static_cast<float>(y < 20 ? 0.0 : 0.001 * x * x);
            f.normal = {std::sin(tilt), 0.0f, std::cos(tilt)};
        }
    }
    return map;
}

struct Counts {
    std::size_t own = 0, in_rows = 0, in_columns = 0;
};

/// Gives each fragment that has its own value that of a plane, the others what lies between.
Counts expect_plane(const SurfaceMap& map, const SmoothRuns::Limits& limits) {
    const SmoothRuns runs(map, limits);
    const auto plane = [&](std::size_t i) {
        const std::uint32_t pixel = map.fragments[i].pixel;
        return 2.0 * (pixel % kWidth) - 3.0 * static_cast<double>(pixel / kWidth);
    };
    constexpr double kNone = -1e9;
    const std::size_t count = map.fragments.size();
    std::vector<double> value(count, kNone);
    Counts counts;
    runs.ends(0, count, [&](std::size_t i) {
        EXPECT_TRUE(runs.is_end(i));
        value[i] = plane(i);
        ++counts.own;
    });
    for (const SmoothRuns::Line line : SmoothRuns::kLines) {
        // Of two halves, as threads have it: nothing is left out or done twice
        const std::vector<double> before = value;
        for (const std::size_t half : {std::size_t{0}, count / 2}) {
            runs.between(line, half, half == 0 ? count / 2 : count, [&](std::size_t i, auto at) {
                EXPECT_EQ(value[i], kNone);
                // Not what is written in the same round
                EXPECT_NE(before[at.first], kNone);
                EXPECT_NE(before[at.second], kNone);
                EXPECT_EQ(map.fragments[at.first].part, map.fragments[i].part);
                EXPECT_EQ(map.fragments[at.second].part, map.fragments[i].part);
                value[i] = (1.0 - static_cast<double>(at.share)) * before[at.first] +
                           static_cast<double>(at.share) * before[at.second];
                EXPECT_NEAR(value[i], plane(i), 1e-4);
                ++(line == SmoothRuns::Line::row ? counts.in_rows : counts.in_columns);
            });
        }
    }
    for (const double one : value) EXPECT_NE(one, kNone);
    return counts;
}

TEST(SmoothRuns, LieBetweenWhatIsKnownBeforeThem) {
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        SCOPED_TRACE(seed);
        const SurfaceMap map = torn_map(seed);
        for (const std::uint32_t longest : {1u, 2u, 4u, 8u}) {
            for (const std::uint32_t highest : {1u, 2u, 4u, 8u}) {
                SCOPED_TRACE(longest);
                SCOPED_TRACE(highest);
                const Counts counts = expect_plane(map, {longest, highest});
                EXPECT_EQ(counts.own + counts.in_rows + counts.in_columns, map.fragments.size());
                EXPECT_EQ(counts.in_rows == 0, longest == 1);
                EXPECT_EQ(counts.in_columns == 0, highest == 1);
            }
        }
    }
}

TEST(SmoothRuns, LeaveAFewFragmentsOfAnEvenSurface) {
    SurfaceMap map;
    map.width = 64;
    map.height = 64;
    for (std::uint32_t pixel = 0; pixel < 64 * 64; ++pixel) {
        Fragment& f = map.fragments.emplace_back();
        f.pixel = pixel;
        f.coverage = 1.0f;
        f.normal = {0.0f, 0.0f, 1.0f};
    }
    const auto own = [&](const SmoothRuns::Limits& limits) {
        std::size_t count = 0;
        SmoothRuns(map, limits).ends(0, map.fragments.size(), [&](std::size_t) { ++count; });
        return static_cast<double>(count) / static_cast<double>(map.fragments.size());
    };
    // The last runs before the edges are shorter
    EXPECT_LT(own({4, 1}), 0.32);
    EXPECT_LT(own({4, 2}), 0.18);
    EXPECT_LT(own({8, 4}), 0.07);
    EXPECT_EQ(own({1, 1}), 1.0);
    EXPECT_THROW(SmoothRuns(map, {3, 1}), std::invalid_argument);
    EXPECT_THROW(SmoothRuns(map, {4, 256}), std::invalid_argument);
    EXPECT_THROW(SmoothRuns(map, {4, 0}), std::invalid_argument);
    EXPECT_THROW(SmoothRuns(map, {4, 1, 1.0, 3}), std::invalid_argument);
}

TEST(SmoothRuns, FragmentsThatShareAPixelTakeTheirNeighbours) {
    // Two parts, each with an edge of fragments that are not whole; those of one fold away.
    SurfaceMap map;
    map.width = 16;
    map.height = 8;
    for (std::uint16_t part = 0; part < 2; ++part) {
        for (std::uint32_t pixel = 0; pixel < 16 * 8; ++pixel) {
            const std::uint32_t x = pixel % 16;
            if (x / 8 != part) continue;
            Fragment& f = map.fragments.emplace_back();
            f.pixel = pixel;
            f.part = part;
            f.coverage = x % 8 == 3 ? 0.5f : 1.0f;
            f.normal = {0.0f, 0.0f, 1.0f};
            if (part == 1 && f.coverage < 1.0f) f.normal = {0.6f, 0.0f, 0.8f};
        }
    }
    const SmoothRuns runs(map, {1, 1, 4.0, 4});
    std::array<std::size_t, 2> beside{};
    for (const SmoothRuns::Line line : SmoothRuns::kLines) {
        runs.between(line, 0, map.fragments.size(), [&](std::size_t i, auto at) {
            EXPECT_EQ(at.first, at.second);
            EXPECT_TRUE(runs.is_end(at.first));
            const Fragment &f = map.fragments[i], &other = map.fragments[at.first];
            EXPECT_LT(f.coverage, 1.0f);
            EXPECT_EQ(f.part, other.part);
            EXPECT_EQ(f.pixel % 16 / 4, other.pixel % 16 / 4);
            EXPECT_EQ(f.pixel / 16 / 4, other.pixel / 16 / 4);
            EXPECT_EQ(f.normal, other.normal);
            ++beside[f.part];
        });
    }
    // Of the edge that folds away one in each block is asked
    EXPECT_EQ(beside[0], 8u);
    EXPECT_EQ(beside[1], 6u);
}

}  // namespace
}  // namespace livery
