// Equation 9 against a world that is known exactly, against a plain double implementation, and
// against everything that goes wrong in a real picture.
#include "compensation/compensation.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

#include "compensation/compensate.h"
#include "compensation/synthetic.h"
#include "core/error.h"
#include "core/parallel.h"
#include "core/worst_error.h"
#include "support/message_of.h"

namespace livery {
namespace {

using synthetic::calibrate;
using synthetic::kInf;
using synthetic::kNan;
using synthetic::make_world;
using synthetic::picture;
using synthetic::World;

/// Equation 9 and the dither, written down once more in doubles and without any baking.
Image8 oracle(const ColourCalibration& c, double white_y, const ImageF& wanted) {
    Image8 out(c.width, c.height, 3);
    const glm::dmat3 camera_from_xyz = glm::inverse(c.xyz_from_camera);
    for (int y = 0; y < c.height; ++y) {
        for (int x = 0; x < c.width; ++x) {
            const float* p = wanted.pixel(x, y);
            if (!is_valid(static_cast<PixelStatus>(c.status.at(x, y)))) continue;
            if (wanted.channels == 4 && !(p[3] >= 0.5f)) continue;
            const glm::dvec3 colour(p[0], p[1], p[2]);
            if (!std::isfinite(colour.x + colour.y + colour.z)) continue;
            const glm::dvec3 camera = camera_from_xyz * (xyz_from_working() * colour * white_y);
            for (int k = 0; k < 3; ++k) {
                double separated = 0.0;
                for (int j = 0; j < 3; ++j) {
                    separated += static_cast<double>(c.unmixing.at(x, y, 3 * k + j)) * camera[j];
                }
                double n = (separated - static_cast<double>(c.dark.at(x, y, k))) /
                           static_cast<double>(c.span.at(x, y, k));
                n = std::clamp(n, 0.0, 1.0);
                const std::vector<float>& curve =
                    c.response[static_cast<std::size_t>(k)].drive_from_n;
                const double at = n * static_cast<double>(curve.size() - 1);
                const auto i = std::min(static_cast<std::size_t>(at), curve.size() - 2);
                const double f = at - static_cast<double>(i);
                const double drive = static_cast<double>(curve[i]) * (1.0 - f) +
                                     static_cast<double>(curve[i + 1]) * f;
                const double dithered =
                    drive + 0.5 +
                    static_cast<double>(
                        dither_of(static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y)));
                out.at(x, y, k) = static_cast<std::uint8_t>(std::min(std::floor(dithered), 255.0));
            }
        }
    }
    return out;
}

struct Difference {
    int largest = 0;
    double changed_fraction = 0.0;
};

Difference difference(const Image8& a, const Image8& b) {
    EXPECT_EQ(a.values.size(), b.values.size());
    Difference d;
    std::size_t changed = 0;
    for (std::size_t i = 0; i < a.values.size(); ++i) {
        const int step = std::abs(static_cast<int>(a.values[i]) - static_cast<int>(b.values[i]));
        d.largest = std::max(d.largest, step);
        changed += step != 0 ? 1u : 0u;
    }
    d.changed_fraction = static_cast<double>(changed) / static_cast<double>(a.values.size());
    return d;
}

// The drives that made a colour come back when that colour is asked for. Rounding with dither
// moves by less than one level, the piecewise linear response by under 0.3 above drive 24.
TEST(Compensate, RecoversTheDrivesThatMadeAColour) {
    for (const std::uint64_t seed : {11u, 12u, 13u}) {
        SCOPED_TRACE(seed);
        const World world = make_world(97, 61, seed);
        Random random(seed + 100);
        std::vector<glm::dvec3> drives;
        const double white_y = 0.4;
        const ImageF wanted = picture(world, [&](std::size_t i) {
            drives.push_back(synthetic::random_drive(random, 24.0, 254.0));
            return world.wanted(i, drives.back(), white_y);
        });
        CompensationStats stats;
        const Image8 out = compensate(bake(calibrate(world), white_y), wanted, &stats);
        double worst = 0.0, sum = 0.0;
        for (std::size_t i = 0; i < drives.size(); ++i) {
            for (std::size_t k = 0; k < 3; ++k) {
                const double error =
                    static_cast<double>(out.values[3 * i + k]) - drives[i][static_cast<int>(k)];
                worst = worse_of(worst, std::abs(error));
                sum += error;
            }
        }
        EXPECT_LT(worst, 1.3);
        // The dither is uniform: the mean of 17,751 errors has a deviation of 0.003 at most.
        EXPECT_NEAR(sum / static_cast<double>(3 * drives.size()), 0.0, 0.02);
        EXPECT_EQ(stats.out_of_gamut_fraction, 0.0);
        EXPECT_EQ(stats.invalid_fraction, 0.0);
    }
}

// What a viewer gets: the light of the compensated picture is the light that was asked for. With
// 8 bits and gamma 2.4 one level is under 1.2% of the light above drive 128: mean error far less.
TEST(Compensate, GivesTheLightThatWasAskedFor) {
    const World world = make_world(120, 80, 21);
    const double white_y = 0.5;
    Random random(5);
    const ImageF wanted = picture(world, [&](std::size_t i) {
        return world.wanted(i, synthetic::random_drive(random, 128.0, 250.0), white_y);
    });
    const Image8 out = compensate(bake(calibrate(world), white_y), wanted);
    double sum_ratio = 0.0, worst = 0.0;
    for (std::size_t i = 0; i < world.mixing.size(); ++i) {
        const glm::dvec3 drive(out.values[3 * i], out.values[3 * i + 1], out.values[3 * i + 2]);
        const glm::dvec3 shown = world.xyz_from_camera * world.camera(i, drive);
        const glm::dvec3 asked =
            xyz_from_working() *
            glm::dvec3(wanted.values[4 * i], wanted.values[4 * i + 1], wanted.values[4 * i + 2]) *
            white_y;
        sum_ratio += shown.y / asked.y;
        worst = worse_of(worst, glm::length(shown - asked) / glm::length(asked));
    }
    EXPECT_NEAR(sum_ratio / static_cast<double>(world.mixing.size()), 1.0, 0.002);
    EXPECT_LT(worst, 0.025);
}

TEST(Compensate, StaysWithinOneLevelOfDoubles) {
    for (const double ambient : {0.0, 0.004, 0.05}) {
        const World world = make_world(131, 77, 31, ambient);
        for (const bool paper : {false, true}) {
            SCOPED_TRACE(::testing::Message() << "ambient " << ambient << " paper " << paper);
            const ColourCalibration calibration =
                paper ? calibrate(world, 64.0, 200.0, 257) : calibrate(world);
            Random random(77);
            // Far out of gamut on both sides, too.
            const ImageF wanted = picture(world, [&](std::size_t) {
                return glm::dvec3(3.0 * random.uniform() - 0.7,
                                  3.0 * random.uniform() - 0.7,
                                  3.0 * random.uniform() - 0.7);
            });
            const Image8 fast = compensate(bake(calibration, 0.3), wanted);
            const Difference d = difference(fast, oracle(calibration, 0.3, wanted));
            EXPECT_LE(d.largest, 1);
            // Only where float rounding crosses a threshold of the dither.
            EXPECT_LT(d.changed_fraction, 0.002);
        }
    }
}

TEST(Compensate, EveryInstructionSetGivesTheSameBits) {
    const World world = make_world(203, 50, 41);
    ColourCalibration calibration = calibrate(world);
    for (std::size_t i = 0; i < calibration.status.values.size(); i += 3) {
        calibration.status.values[i] = 0;
    }
    const CompensationTable table = bake(calibration, 0.3);
    Random random(3);
    ImageF wanted =
        picture(world, [&](std::size_t) { return glm::dvec3(random.uniform() * 2.0 - 0.5); });
    for (std::size_t i = 0; i < wanted.values.size(); i += 37) wanted.values[i] = kNan;
    for (std::size_t i = 5; i < wanted.values.size(); i += 41) wanted.values[i] = -kInf;
    const std::size_t count = kernel::available_count();
    ASSERT_GE(count, 1u);
    EXPECT_STREQ(kernel::available(count - 1).instruction_set, "baseline");
    Image8 baseline;
    CompensationStats baseline_stats;
    const std::size_t covered = count_covered(wanted);
    compensate_with(
        kernel::available(count - 1), table, wanted, covered, &baseline, &baseline_stats);
    for (std::size_t i = 0; i + 1 < count; ++i) {
        SCOPED_TRACE(kernel::available(i).instruction_set);
        Image8 out;
        CompensationStats stats;
        compensate_with(kernel::available(i), table, wanted, covered, &out, &stats);
        EXPECT_EQ(out.values, baseline.values);
        EXPECT_EQ(stats.out_of_gamut_fraction, baseline_stats.out_of_gamut_fraction);
        EXPECT_EQ(stats.invalid_fraction, baseline_stats.invalid_fraction);
    }
}

TEST(Compensate, BlackWhereNothingValidIsAskedFor) {
    // Column 15 is further from what is known than a border's fade reaches.
    World world = make_world(16, 4, 51);
    for (std::size_t i = 0; i < world.lit.size(); ++i) world.lit[i] = i % 16 < 8;
    const CompensationTable table = bake(calibrate(world), 0.3);
    const glm::dvec3 grey(0.3);
    ImageF wanted = picture(world, [&](std::size_t) { return grey; });
    for (int y = 0; y < 4; ++y) {
        for (int x = 8; x < 16; ++x) wanted.at(x, y, 3) = x == 15 && y == 0 ? 1.0f : 0.0f;
    }
    wanted.at(0, 0, 0) = kNan;
    wanted.at(1, 0, 1) = kInf;
    wanted.at(2, 0, 2) = -kInf;
    wanted.at(3, 0, 3) = 0.49f;
    wanted.at(4, 0, 3) = kNan;
    wanted.at(6, 0, 3) = 0.5f;
    CompensationStats stats;
    const Image8 out = compensate(table, wanted, &stats);
    for (const int x : {0, 1, 2, 3, 4, 15}) {
        for (int k = 0; k < 3; ++k) EXPECT_EQ(out.at(x, 0, k), 0) << x;
    }
    for (int k = 0; k < 3; ++k) {
        EXPECT_GT(out.at(6, 0, k), 60);
        EXPECT_GT(out.at(7, 3, k), 60);
    }
    // 33 pixels less two without coverage; NaN, two Inf and the unlit one are invalid.
    EXPECT_DOUBLE_EQ(stats.invalid_fraction, 4.0 / 31.0);
    EXPECT_EQ(stats.out_of_gamut_fraction, 0.0);
}

TEST(Compensate, HugeAndDenormalColoursStayFiniteAndClip) {
    const World world = make_world(4, 2, 52);
    const CompensationTable table = bake(calibrate(world), 0.3);
    for (const float value : {1e30f, 3e38f, -3e38f, 1e-40f, -1e-40f, 65504.0f}) {
        ImageF wanted(4, 2, 3, value);
        CompensationStats stats;
        const Image8 out = compensate(table, wanted, &stats);
        EXPECT_LE(stats.out_of_gamut_fraction, 1.0) << value;
        if (value == 65504.0f) {
            for (const std::uint8_t level : out.values) EXPECT_EQ(level, 255);
            EXPECT_EQ(stats.clipped_high_fraction, 1.0);
        }
    }
}

TEST(Compensate, CountsTooBrightAndTooDarkApart) {
    const World world = make_world(40, 30, 53, 0.02);
    const CompensationTable table = bake(calibrate(world), 0.3);
    ImageF wanted = picture(world, [&](std::size_t i) {
        if (i % 4 == 0) return glm::dvec3(0.0);   // under ambient and leak
        if (i % 4 == 1) return glm::dvec3(50.0);  // over white
        return world.wanted(i, glm::dvec3(128.0), 0.3);
    });
    CompensationStats stats;
    const Image8 out = compensate(table, wanted, &stats);
    EXPECT_DOUBLE_EQ(stats.clipped_low_fraction, 0.25);
    EXPECT_DOUBLE_EQ(stats.clipped_high_fraction, 0.25);
    EXPECT_DOUBLE_EQ(stats.out_of_gamut_fraction, 0.5);
    for (int k = 0; k < 3; ++k) {
        EXPECT_EQ(out.at(0, 0, k), 0);
        EXPECT_EQ(out.at(1, 0, k), 255);
    }
}

TEST(Compensate, PaperModeEndsAtItsGreyLevels) {
    const World world = make_world(16, 8, 54);
    const CompensationTable table = bake(calibrate(world, 64.0, 200.0, 257), 0.3);
    const Image8 dark = compensate(table, ImageF(16, 8, 3, -1.0f));
    const Image8 bright = compensate(table, ImageF(16, 8, 3, 50.0f));
    for (const std::uint8_t level : dark.values) EXPECT_EQ(level, 64);
    for (const std::uint8_t level : bright.values) EXPECT_EQ(level, 200);
}

TEST(Compensate, ThreeChannelsMeanFullyCovered) {
    const World world = make_world(33, 9, 55);
    const CompensationTable table = bake(calibrate(world), 0.3);
    const ImageF four = picture(world, [](std::size_t i) {
        return glm::dvec3(0.1 + 0.001 * static_cast<double>(i % 100));
    });
    ImageF three(33, 9, 3);
    for (std::size_t i = 0; i < three.pixel_count(); ++i) {
        for (std::size_t k = 0; k < 3; ++k) three.values[3 * i + k] = four.values[4 * i + k];
    }
    EXPECT_EQ(compensate(table, three).values, compensate(table, four).values);
}

TEST(Compensate, ReusedPictureForgetsTheLastFrame) {
    const World world = make_world(33, 9, 56);
    const CompensationTable table = bake(calibrate(world), 0.3);
    Image8 out;
    compensate_into(table, ImageF(33, 9, 4, 1.0f), &out);
    const std::uint8_t* memory = out.values.data();
    compensate_into(table, ImageF(33, 9, 4, 0.0f), &out);  // coverage 0
    EXPECT_EQ(out.values.data(), memory);
    EXPECT_EQ(*std::max_element(out.values.begin(), out.values.end()), 0);
}

TEST(Compensate, FramesOfAShowAreThoseFromNothingOnAnyNumberOfThreads) {
    World world = make_world(211, 190, 58);
    for (std::size_t i = 0; i < world.lit.size(); i += 7) world.lit[i] = false;
    const CompensationTable table = bake(calibrate(world), 0.3);
    Random random(5);
    Image8 kept, kept_alone;
    for (int frame = 0; frame < 4; ++frame) {
        ImageF wanted =
            picture(world, [&](std::size_t) { return glm::dvec3(random.uniform() * 1.5 - 0.2); });
        for (std::size_t i = 3; i < wanted.values.size(); i += 4 * 5) wanted.values[i] = 0.2f;
        for (std::size_t i = 4; i < wanted.values.size(); i += 97) wanted.values[i] = kNan;
        CompensationStats stats, stats_again, stats_alone;
        const Image8 fresh = compensate(table, wanted, &stats);
        const std::size_t covered = count_covered(wanted);
        compensate_again(table, wanted, covered, &kept, &stats_again);
        set_thread_count(1);
        compensate_again(table, wanted, covered, &kept_alone, &stats_alone);
        set_thread_count(0);
        EXPECT_EQ(kept.values, fresh.values);
        EXPECT_EQ(kept_alone.values, fresh.values);
        EXPECT_GT(stats.invalid_fraction, 0.0);
        for (const CompensationStats& other : {stats_again, stats_alone}) {
            EXPECT_EQ(other.invalid_fraction, stats.invalid_fraction);
            EXPECT_EQ(other.out_of_gamut_fraction, stats.out_of_gamut_fraction);
            EXPECT_EQ(other.clipped_high_fraction, stats.clipped_high_fraction);
            EXPECT_EQ(other.clipped_low_fraction, stats.clipped_low_fraction);
        }
    }
}

TEST(Compensate, EmptyCalibrationShowsBlack) {
    World world = make_world(10, 6, 57);
    world.lit.assign(world.lit.size(), false);
    const ColourCalibration calibration = calibrate(world);
    CompensationStats stats;
    const Image8 out = compensate(bake(calibration, 1.0), ImageF(10, 6, 4, 1.0f), &stats);
    EXPECT_EQ(*std::max_element(out.values.begin(), out.values.end()), 0);
    EXPECT_EQ(stats.invalid_fraction, 1.0);
    EXPECT_EQ(stats.out_of_gamut_fraction, 0.0);
    try {
        design_white_luminance(calibration, 20.0, {});
        FAIL() << "an answer from nothing";
    } catch (const Refused& refused) {
        EXPECT_NE(refused.why().find("no pixel of the mock-up"), std::string::npos);
        EXPECT_NE(refused.fix().find("status picture"), std::string::npos);
    }
}

TEST(Compensate, NamesWrongSizes) {
    const World world = make_world(10, 6, 58);
    const CompensationTable table = bake(calibrate(world), 0.3);
    EXPECT_EQ(message_of([&] { compensate(table, ImageF(9, 6, 4)); }),
              "wanted picture of 9x6 with 4 channels, the calibration has 10x6 and wants 3 or 4");
    EXPECT_NE(message_of([&] { compensate(table, ImageF(10, 6, 1)); }).find("with 1 channels"),
              std::string::npos);
    EXPECT_NE(message_of([&] { compensate(table, ImageF()); }).find("0x0"), std::string::npos);
}

TEST(Compensate, DitherIsUniformAndDiffersBetweenNeighbours) {
    double sum = 0.0, square = 0.0;
    std::array<int, 16> histogram{};
    for (std::uint32_t y = 0; y < 128; ++y) {
        for (std::uint32_t x = 0; x < 128; ++x) {
            const float d = dither_of(x, y);
            ASSERT_GE(d, -0.5f);
            ASSERT_LT(d, 0.5f);
            EXPECT_GT(std::abs(d - dither_of(x + 1, y)), 0.1f);
            sum += static_cast<double>(d);
            square += static_cast<double>(d) * static_cast<double>(d);
            ++histogram[static_cast<std::size_t>((d + 0.5f) * 16.0f)];
        }
    }
    EXPECT_NEAR(sum / 16384.0, 0.0, 1e-3);
    EXPECT_NEAR(square / 16384.0, 1.0 / 12.0, 1e-3);
    // A low-discrepancy lattice fills 1024 expected a bin far more evenly than chance (+-32).
    for (const int bin : histogram) EXPECT_NEAR(bin, 1024, 16);
}

}  // namespace
}  // namespace livery
