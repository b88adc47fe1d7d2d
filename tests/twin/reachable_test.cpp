// reachable() against a search over all that the projector can do.
#include <algorithm>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/random.h"
#include "small_bench.h"

namespace livery {
namespace {

using namespace livery::testing;

struct Pixel {
    glm::dvec3 black{0.0}, primary[3], clear{0.0};

    glm::dvec3 shows(const glm::dvec3& light) const {
        const double common = std::min({light.x, light.y, light.z});
        return black + light.x * primary[0] + light.y * primary[1] + light.z * primary[2] +
               common * clear;
    }
};

/// What the bench shows at one pixel, from its pictures alone.
Pixel observed(const Bench& bench, const BenchDescription& description) {
    const auto at = [&](int r, int g, int b) {
        const ImageF xyz = bench.observe_xyz(filled(description, r, g, b));
        return glm::dvec3(xyz.at(80, 60, 0), xyz.at(80, 60, 1), xyz.at(80, 60, 2));
    };
    Pixel pixel;
    pixel.black = at(0, 0, 0);
    pixel.primary[0] = at(255, 0, 0) - pixel.black;
    pixel.primary[1] = at(0, 255, 0) - pixel.black;
    pixel.primary[2] = at(0, 0, 255) - pixel.black;
    pixel.clear =
        at(255, 255, 255) - pixel.black - pixel.primary[0] - pixel.primary[1] - pixel.primary[2];
    return pixel;
}

/// Smallest distance to `wanted` over all drives: a coarse grid, then ever smaller steps from its
/// best places (the distance is not convex where the smallest channel changes).
double distance_to_gamut(const Pixel& pixel, const glm::dvec3& wanted) {
    std::vector<std::pair<double, glm::dvec3>> starts;
    constexpr int kGrid = 12;
    for (int i = 0; i <= kGrid; ++i) {
        for (int j = 0; j <= kGrid; ++j) {
            for (int k = 0; k <= kGrid; ++k) {
                const glm::dvec3 light = glm::dvec3(i, j, k) / double(kGrid);
                starts.emplace_back(glm::distance(pixel.shows(light), wanted), light);
            }
        }
    }
    std::partial_sort(starts.begin(), starts.begin() + 6, starts.end(), [](auto& a, auto& b) {
        return a.first < b.first;
    });
    double best = 1e30;
    for (std::size_t s = 0; s < 6; ++s) {
        auto [distance, light] = starts[s];
        for (double step = 0.5 / kGrid; step > 1e-6; step *= 0.7) {
            for (int turn = 0; turn < 4; ++turn) {
                for (int i = -1; i <= 1; ++i) {
                    for (int j = -1; j <= 1; ++j) {
                        for (int k = -1; k <= 1; ++k) {
                            const glm::dvec3 next =
                                glm::clamp(light + step * glm::dvec3(i, j, k), 0.0, 1.0);
                            const double there = glm::distance(pixel.shows(next), wanted);
                            if (there < distance) {
                                distance = there;
                                light = next;
                            }
                        }
                    }
                }
            }
        }
        best = std::min(best, distance);
    }
    return best;
}

class Reachable : public ::testing::TestWithParam<double> {};

TEST_P(Reachable, AgreesWithASearchOverAllDrives) {
    BenchDescription description = wall_bench();
    description.projector.white_segment = GetParam();
    description.projector.leak = 0.004;
    description.ambient = 0.01;
    const Bench bench(description, product_of(make_wall()));
    const Pixel pixel = observed(bench, description);
    Random random(11);
    int inside = 0, outside = 0;
    for (int trial = 0; trial < 120; ++trial) {
        // Around and beyond what the primaries reach, the clear segment's share included.
        glm::dvec3 light;
        for (int c = 0; c < 3; ++c) light[c] = -0.15 + 1.35 * random.uniform();
        const double common = (random.uniform() < 0.5 ? 1.0 : 0.4) *
                              std::clamp(std::min({light.x, light.y, light.z}), 0.0, 1.0);
        const glm::dvec3 wanted = pixel.black + light.x * pixel.primary[0] +
                                  light.y * pixel.primary[1] + light.z * pixel.primary[2] +
                                  common * pixel.clear;
        const double distance = distance_to_gamut(pixel, wanted);
        if (distance > 1e-5 && distance < 1e-3)
            continue;  // on the boundary: neither answer is wrong
        ImageF picture(160, 120, 3);
        for (int c = 0; c < 3; ++c) picture.at(80, 60, c) = static_cast<float>(wanted[c]);
        const bool answer = bench.reachable(picture).at(80, 60) == 255;
        EXPECT_EQ(answer, distance <= 1e-5) << "trial " << trial << ", distance " << distance;
        ++(answer ? inside : outside);
    }
    EXPECT_GT(inside, 20);
    EXPECT_GT(outside, 20);
}

INSTANTIATE_TEST_SUITE_P(WhiteSegments, Reachable, ::testing::Values(0.0, 0.8));

TEST(ReachableEnds, FullDriveAndBlackAreReachableAndABitBeyondIsNot) {
    for (const double segment : {0.0, 0.5}) {
        BenchDescription description = wall_bench();
        description.projector.white_segment = segment;
        description.projector.leak = 0.01;
        const Bench bench(description, product_of(make_wall()));
        const auto share = [&](const ImageF& wanted) {
            const Image8 answer = bench.reachable(wanted);
            int yes = 0;
            for (const auto value : answer.values) yes += value == 255;
            return double(yes) / double(answer.pixel_count());
        };
        ImageF white = bench.observe_xyz(filled(description, 255, 255, 255));
        EXPECT_EQ(share(white), 1.0);
        EXPECT_EQ(share(bench.truth().black_xyz), 1.0);
        for (float& value : white.values) value *= 1.002f;
        EXPECT_EQ(share(white), 0.0);
        ImageF dark = bench.truth().black_xyz;
        for (float& value : dark.values) value *= 0.9f;
        EXPECT_EQ(share(dark), 0.0);
    }
}

}  // namespace
}  // namespace livery
