// The shipped environments against closed forms and their description in docs/assets.md.
#include <cmath>
#include <numbers>
#include <string>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/image_io.h"
#include "core/paths.h"
#include "core/worst_error.h"
#include "environments.h"
#include "scene/look.h"

namespace livery {
namespace {

constexpr double kPi = std::numbers::pi;

ImageF shipped(const std::string& name) {
    return read_image(shipped_path("assets/environments/" + name)).image;
}

double luminance(const ImageF& map, int x, int y) {
    return 0.2126 * map.at(x, y, 0) + 0.7152 * map.at(x, y, 1) + 0.0722 * map.at(x, y, 2);
}

/// Toward the map's pixel, by the convention that the renderers use.
glm::dvec3 direction_of(const ImageF& map, int x, int y) {
    return direction_from_uv(Environment{}, {(x + 0.5) / map.width, (y + 0.5) / map.height});
}

/// Sum of luminance times `weight(direction)` over solid angle.
template <typename Weight>
double integral(const ImageF& map, Weight&& weight) {
    double sum = 0.0;
    for (int y = 0; y < map.height; ++y) {
        // The exact solid angle of a pixel in this row.
        const double area = 2.0 * kPi / map.width *
                            (std::cos(kPi * y / map.height) - std::cos(kPi * (y + 1) / map.height));
        for (int x = 0; x < map.width; ++x) {
            sum += luminance(map, x, y) * weight(direction_of(map, x, y)) * area;
        }
    }
    return sum;
}

double toward(const ImageF& map, const glm::dvec3& direction) {
    const auto uv = uv_from_direction(Environment{}, glm::normalize(direction));
    return luminance(map, static_cast<int>(uv.x * map.width), static_cast<int>(uv.y * map.height));
}

TEST(Environments, AreFiniteAndNotNegative) {
    for (const char* name : {"studio.hdr", "overcast.hdr"}) {
        const auto map = shipped(name);
        EXPECT_EQ(map.width, 1024) << name;
        EXPECT_EQ(map.height, 512) << name;
        for (const float value : map.values) {
            ASSERT_TRUE(std::isfinite(value) && value >= 0.0f) << name << ": " << value;
        }
    }
}

TEST(Environments, FileHoldsTheMapToTheFormatsPrecision) {
    // RGBE keeps 8 bits below the largest channel's power of two and rounds: 1/256 of the largest.
    const auto made = assets::environment_map(assets::studio_radiance, 1024);
    const auto read = shipped("studio.hdr");
    for (int y = 0; y < made.height; ++y) {
        for (int x = 0; x < made.width; ++x) {
            const float largest = std::max({made.at(x, y, 0), made.at(x, y, 1), made.at(x, y, 2)});
            for (int c = 0; c < 3; ++c) {
                ASSERT_NEAR(read.at(x, y, c), made.at(x, y, c), largest / 255.0f);
            }
        }
    }
}

TEST(Studio, HasItsAverageAndItsLightsWhereTheyShouldBe) {
    const auto map = shipped("studio.hdr");
    const double mean = integral(map, [](const glm::dvec3&) { return 1.0; }) / (4.0 * kPi);
    // What the generator prints is what this other integral finds.
    const double level =
        integral(map, [](const glm::dvec3& d) { return std::max(d.y, 0.0); }) / kPi;
    EXPECT_NEAR(assets::averages(map).mean_radiance, mean, 1e-6);
    EXPECT_NEAR(assets::averages(map).level_white, level, 1e-4);
    EXPECT_GT(mean, 0.3);
    EXPECT_LT(mean, 0.5);
    // Overhead, along the car, which points along x.
    EXPECT_GT(toward(map, {0, 1, 0}), 4.0);
    EXPECT_GT(toward(map, {0.5, 1, 0}), 3.5);
    EXPECT_LT(toward(map, {0, 1, 0.6}), 0.5);
    // Strips on both sides, the rim light behind, the wall in front.
    EXPECT_GT(toward(map, {0.0, 0.25, 1.0}), 5.0);
    EXPECT_GT(toward(map, {0.0, 0.23, -1.0}), 3.5);
    EXPECT_GT(toward(map, {-1.0, 0.55, -0.15}), 6.0);
    EXPECT_LT(toward(map, {1.0, 0.1, 0.0}), 0.2);
    // A light floor that grows lighter downward, without a step at the horizon.
    EXPECT_GT(toward(map, {0, -1, 0}), 0.3);
    EXPECT_LT(std::abs(toward(map, {1, 0.01, 0}) - toward(map, {1, -0.01, 0})), 0.02);
}

TEST(Studio, IsSmooth) {
    // Soft edges: no neighbouring pixels differ by more than 15% of the brightest light.
    const auto map = shipped("studio.hdr");
    double steepest = 0.0;
    for (int y = 0; y + 1 < map.height; ++y) {
        for (int x = 0; x < map.width; ++x) {
            if (std::abs(direction_of(map, x, y).y) > 0.98) continue;  // columns crowd at the poles
            const double here = luminance(map, x, y);
            steepest = worse_of(steepest, std::abs(here - luminance(map, (x + 1) % map.width, y)));
            steepest = worse_of(steepest, std::abs(here - luminance(map, x, y + 1)));
        }
    }
    EXPECT_LT(steepest, 0.15 * 8.0);
}

TEST(Overcast, LightsALevelWhiteDiffuserToOne) {
    const auto map = shipped("overcast.hdr");
    const double up = integral(map, [](const glm::dvec3& d) { return std::max(d.y, 0.0); }) / kPi;
    EXPECT_NEAR(up, 1.0, 0.004);  // RGBE's rounding
    // From below only the ground shines: its reflectance.
    const double down =
        integral(map, [](const glm::dvec3& d) { return std::max(-d.y, 0.0); }) / kPi;
    EXPECT_NEAR(down, 0.2, 0.001);
}

TEST(Overcast, ZenithIsThreeTimesTheHorizon) {
    const auto map = shipped("overcast.hdr");
    EXPECT_NEAR(toward(map, {0, 1, 0}) / toward(map, {1, 0.0031, 0}), 3.0, 0.04);
}

}  // namespace
}  // namespace livery
