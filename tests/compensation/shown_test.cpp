// What a drive shows, against worlds that are known exactly.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <stdexcept>

#include <gtest/gtest.h>

#include "compensation/compensate.h"
#include "compensation/lit_pixels.h"
#include "compensation/synthetic.h"
#include "compensation/white_segment.h"
#include "core/random.h"
#include "core/worst_error.h"

namespace livery {
namespace {

using synthetic::make_world;
using synthetic::picture;
using synthetic::World;

constexpr double kWhiteY = 0.3;

Image8 random_drives(const World& world, std::uint64_t seed) {
    Random random(seed);
    Image8 drive(world.width, world.height, 3);
    for (std::uint8_t& value : drive.values) value = static_cast<std::uint8_t>(random.below(256));
    return drive;
}

/// The farthest that any channel of a lit pixel is from what the world shows for its drive.
template <typename Camera>
double worst_difference(const World& world,
                        const ImageF& shown,
                        const Image8& drive,
                        const Camera& camera) {
    double worst = 0.0;
    for (std::size_t i = 0; i < world.mixing.size(); ++i) {
        if (!world.lit[i]) continue;
        const std::uint8_t* d = &drive.values[3 * i];
        const glm::dvec3 rgb = working_from_xyz() *
                               (world.xyz_from_camera * camera(i, glm::dvec3(d[0], d[1], d[2]))) /
                               kWhiteY;
        for (std::size_t c = 0; c < 3; ++c) {
            const double apart =
                static_cast<double>(shown.values[4 * i + c]) - rgb[static_cast<int>(c)];
            worst = worse_of(worst, std::abs(apart));
        }
    }
    return worst;
}

TEST(Shown, IsWhatAnAdditiveProjectorShows) {
    World world = make_world(40, 30, 5);
    for (std::size_t i = 0; i < world.lit.size(); ++i) world.lit[i] = i % 40 >= 10;
    const CompensationTable table = bake(synthetic::calibrate(world), kWhiteY);
    const Image8 drive = random_drives(world, 9);
    const ImageF shown = shown_by(table, drive);
    EXPECT_EQ(shown.values[4 * 3 + 3], 0.0f) << "a pixel without a correction";
    EXPECT_EQ(shown.values[4 * 10 + 3], 1.0f);
    // Between two of its 1024 samples a curve is taken to be straight: never off by more than one
    // of them, of a span of up to twice design white
    EXPECT_LT(
        worst_difference(
            world, shown, drive, [&](std::size_t i, glm::dvec3 d) { return world.camera(i, d); }),
        2.0 / 1023.0);
}

// At a border less is shown than was wanted, by what its light lacks.
TEST(Shown, TellsWhatAFadedPixelLacks) {
    World world = make_world(40, 30, 5);
    for (glm::dmat3& mixing : world.mixing) mixing = world.mixing.front();
    for (std::size_t i = 0; i < world.lit.size(); ++i) world.lit[i] = i % 40 < 20;
    const CompensationTable table = bake(synthetic::calibrate(world), kWhiteY);
    const glm::dvec3 black = world.wanted(0, glm::dvec3(0.0), kWhiteY);
    const glm::dvec3 asked = world.wanted(0, glm::dvec3(180.0), kWhiteY);
    const ImageF wanted = synthetic::picture(world, [&](std::size_t) { return asked; });
    const ImageF shown = shown_by(table, exact_drive(table, wanted));
    const double expected[] = {1.0, 1.0, 0.72, 0.36, 0.12};
    for (int k = 0; k < 5; ++k) {
        const glm::dvec3 here(
            shown.at(19 + k, 9, 0), shown.at(19 + k, 9, 1), shown.at(19 + k, 9, 2));
        for (int c = 0; c < 3; ++c) {
            EXPECT_NEAR((here[c] - black[c]) / (asked[c] - black[c]), expected[k], 0.003) << k;
        }
    }
    EXPECT_EQ(shown.at(24, 9, 3), 0.0f);
}

/// Asked for what a drive shows, the correction gives that drive, or a level beside it.
void expect_inverse(const CompensationTable& table, const World& world, const Image8& drive) {
    const Image8 again = compensate(table, shown_by(table, drive));
    std::size_t far = 0;
    for (std::size_t i = 0; i < 3 * world.mixing.size(); ++i) {
        if (std::abs(again.values[i] - drive.values[i]) > 1) ++far;
    }
    EXPECT_EQ(far, 0u);
}

TEST(Shown, IsWhatTheCorrectionAnswersWithThatDrive) {
    const World world = make_world(40, 30, 6);
    expect_inverse(bake(synthetic::calibrate(world), kWhiteY), world, random_drives(world, 3));
    expect_inverse(
        bake(synthetic::calibrate_segment(world, 17), kWhiteY), world, random_drives(world, 4));
}

/// The drives that are asked for a picture show it, to what floats leave of it.
void expect_exact(const CompensationTable& table, const World& world) {
    const ImageF wanted = picture(world, [](std::size_t i) {
        return glm::dvec3(0.1 + 0.0001 * static_cast<double>(i), 0.2, 0.15);
    });
    const ImageF shown = shown_by(table, exact_drive(table, wanted));
    const Image8 drive = compensate(table, wanted);
    double worst = 0.0, worst_in_levels = 0.0;
    for (std::size_t i = 0; i < wanted.values.size(); ++i) {
        worst = worse_of(worst, std::abs(static_cast<double>(shown.values[i] - wanted.values[i])));
    }
    const ImageF exact = exact_drive(table, wanted);
    for (std::size_t i = 0; i < exact.values.size(); ++i) {
        worst_in_levels = worse_of(
            worst_in_levels, std::abs(static_cast<double>(exact.values[i]) - drive.values[i]));
    }
    EXPECT_LT(worst, 1e-4);
    EXPECT_LE(worst_in_levels, 1.0 + 1e-3) << "a dither adds less than a level";
    EXPECT_GT(worst_in_levels, 0.5);
}

TEST(Shown, IsWhatWasWantedOfDrivesBetweenWholeLevels) {
    const World world = make_world(40, 30, 6);
    expect_exact(bake(synthetic::calibrate(world), kWhiteY), world);
    expect_exact(bake(synthetic::calibrate_segment(world, 17), kWhiteY), world);
}

TEST(Shown, ReachIsAllOfAModestLookAndLittleOfOneTooBright) {
    const World world = make_world(40, 30, 5);
    const CompensationTable table = bake(synthetic::calibrate(world), kWhiteY);
    const auto reach = [&](const glm::dvec3& colour) {
        const ImageF wanted = picture(world, [&](std::size_t) { return colour; });
        return reach_of(table, wanted, compensate(table, wanted));
    };
    const PictureReach grey = reach(glm::dvec3(0.2));
    EXPECT_EQ(grey.pixels, world.mixing.size());
    EXPECT_GT(grey.reachable_fraction, 0.99);
    EXPECT_LT(grey.de00_p95, 1.0);
    const PictureReach bright = reach(glm::dvec3(4.0));
    EXPECT_LT(bright.reachable_fraction, 0.05);
    EXPECT_GT(bright.de00_median, 3.0);
    std::printf("    grey: %.3f, %.2f / %.2f; bright: %.3f, %.2f / %.2f\n",
                grey.reachable_fraction,
                grey.de00_median,
                grey.de00_p95,
                bright.reachable_fraction,
                bright.de00_median,
                bright.de00_p95);
}

TEST(Shown, WhatIsNoNumberIsFarOffAndWhatIsNotCoveredDoesNotCount) {
    const World world = make_world(8, 6, 5);
    const CompensationTable table = bake(synthetic::calibrate(world), kWhiteY);
    ImageF wanted = picture(world, [](std::size_t) { return glm::dvec3(0.2); });
    const Image8 drive = compensate(table, wanted);
    for (std::size_t i = 0; i < 24; ++i) wanted.values[4 * i + 3] = 0.25f;
    EXPECT_EQ(reach_of(table, wanted, drive).pixels, 24u);
    for (std::size_t i = 24; i < 30; ++i) {
        wanted.values[4 * i] = std::numeric_limits<float>::quiet_NaN();
    }
    const PictureReach reach = reach_of(table, wanted, drive);
    EXPECT_NEAR(reach.reachable_fraction, 18.0 / 24.0, 1e-9);
    EXPECT_TRUE(std::isinf(reach.de00_p95));
    for (std::size_t i = 0; i < 48; ++i) wanted.values[4 * i + 3] = 0.0f;
    EXPECT_EQ(reach_of(table, wanted, drive).pixels, 0u);
}

TEST(Shown, OtherSizesAreRefused) {
    const World world = make_world(8, 6, 5);
    const CompensationTable table = bake(synthetic::calibrate(world), kWhiteY);
    EXPECT_THROW(shown_by(table, Image8(8, 5, 3)), std::invalid_argument);
    EXPECT_THROW(shown_by(table, Image8(8, 6, 1)), std::invalid_argument);
    EXPECT_THROW(shown_by(table, ImageF(8, 5, 3)), std::invalid_argument);
    EXPECT_THROW(exact_drive(table, ImageF(8, 5, 3)), std::invalid_argument);
    EXPECT_THROW(reach_of(table, ImageF(8, 6, 3), Image8(8, 6, 3)), std::invalid_argument);
}

}  // namespace
}  // namespace livery
