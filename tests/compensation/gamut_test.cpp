// What happens to colours that the mock-up cannot show.
#include "compensation/gamut.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

#include "compensation/compensate.h"
#include "compensation/compensation.h"
#include "compensation/white_segment.h"
#include "core/worst_error.h"

namespace livery {
namespace {

using synthetic::calibrate;
using synthetic::World;

constexpr double kWhite = 0.3;

/// The same surface everywhere under the same light: the neighbourhood is the pixel.
World even_world(int width, int height, double ambient) {
    World world = synthetic::make_world(width, height, 91, ambient);
    for (std::size_t i = 0; i < world.mixing.size(); ++i) world.mixing[i] = world.mixing[0];
    return world;
}

glm::dvec3 oklab_of(const ImageF& image, std::size_t i) {
    const auto c = static_cast<std::size_t>(image.channels);
    return oklab_from_xyz(xyz_from_working() * glm::dvec3(image.values[c * i],
                                                          image.values[c * i + 1],
                                                          image.values[c * i + 2]));
}

double chroma(const glm::dvec3& oklab) { return std::hypot(oklab.y, oklab.z); }

double hue_difference_deg(const glm::dvec3& a, const glm::dvec3& b) {
    const double d = std::atan2(a.z, a.y) - std::atan2(b.z, b.y);
    return std::abs(std::remainder(d, 2.0 * std::numbers::pi)) * 180.0 / std::numbers::pi;
}

glm::dvec3 working_of(double lightness, double c, double hue) {
    return working_from_xyz() * xyz_from_oklab({lightness, c * std::cos(hue), c * std::sin(hue)});
}

CompensationTable preserving(CompensationTable table) {
    table.gamut = make_gamut_boundary(table);
    return table;
}

ImageF preserve(const CompensationTable& table, const ImageF& wanted) {
    return map_gamut(kernel::best(), preserving(table), wanted);
}

ImageF random_colours(const World& world, std::uint64_t seed, double most_chroma) {
    Random random(seed);
    return synthetic::picture(world, [&](std::size_t) {
        return working_of(0.15 + 0.95 * random.uniform(),
                          most_chroma * random.uniform(),
                          6.2831853 * random.uniform());
    });
}

TEST(Gamut, StrictReturnsWhatWasWanted) {
    const World world = even_world(20, 10, 0.004);
    const ImageF wanted = random_colours(world, 1, 0.4);
    const CompensationTable table = bake(calibrate(world), kWhite);
    EXPECT_EQ(map_gamut(kernel::best(), table, wanted).values, wanted.values);
}

// What is sent is the correction of the moved colours, and what is counted speaks of the wanted
// ones; on every instruction set to the bit.
TEST(Gamut, ABakedMappingRunsWithinTheCorrection) {
    for (const bool segment : {false, true}) {
        SCOPED_TRACE(segment ? "clear segment" : "additive");
        const World world = synthetic::make_world(65, 31, 97, 0.004);
        const ColourCalibration calibration =
            segment ? synthetic::calibrate_segment(world) : calibrate(world);
        const CompensationTable strict = bake(calibration, kWhite);
        const CompensationTable table = bake(calibration, kWhite, GamutMapping::preserve);
        const ImageF wanted = random_colours(world, 8, 0.4);
        CompensationStats of_strict, stats;
        const Image8 clipped = compensate(strict, wanted, &of_strict);
        const Image8 drive = compensate(table, wanted, &stats);
        EXPECT_NE(drive.values, clipped.values);
        EXPECT_EQ(stats.out_of_gamut_fraction, of_strict.out_of_gamut_fraction);
        EXPECT_EQ(stats.clipped_high_fraction, of_strict.clipped_high_fraction);
        EXPECT_EQ(stats.clipped_low_fraction, of_strict.clipped_low_fraction);
        EXPECT_GT(stats.out_of_gamut_fraction, 0.2);
        for (std::size_t k = 0; k < kernel::available_count(); ++k) {
            SCOPED_TRACE(kernel::available(k).instruction_set);
            const ImageF mapped = map_gamut(kernel::available(k), table, wanted);
            EXPECT_EQ(compensate(strict, mapped).values, drive.values);
        }
    }
}

// Two looks that are compared: where both want the same colour they show the same, whatever else
// either of them wants.
TEST(Gamut, TheMapDoesNotDependOnThePicture) {
    const World world = synthetic::make_world(64, 48, 98, 0.004);
    const CompensationTable table = bake(calibrate(world), kWhite, GamutMapping::preserve);
    const ImageF look = random_colours(world, 9, 0.4);
    ImageF other = random_colours(world, 10, 0.05);
    for (std::size_t i = 0; i < other.values.size(); ++i) {
        if (i / 4 % 2 == 0) other.values[i] = look.values[i];
    }
    const Image8 of_look = compensate(table, look), of_other = compensate(table, other);
    std::size_t different = 0;
    for (std::size_t i = 0; i < of_look.values.size(); ++i) {
        if (i / 3 % 2 == 0) {
            EXPECT_EQ(of_look.values[i], of_other.values[i]) << i;
        } else {
            different += of_look.values[i] != of_other.values[i] ? 1u : 0u;
        }
    }
    EXPECT_GT(different, of_look.values.size() / 4);
}

// Under the knee nothing moves, to the bit: a colour whose chroma could grow to 1/0.85 of itself
// and whose lightness is well inside.
TEST(Gamut, ColoursUnderTheKneeAreUntouched) {
    const World world = even_world(40, 30, 0.002);
    const CompensationTable table = bake(calibrate(world), kWhite);
    Random random(2);
    const ImageF wanted = synthetic::picture(world, [&](std::size_t) {
        return working_of(
            0.4 + 0.3 * random.uniform(), 0.05 * random.uniform(), 6.28 * random.uniform());
    });
    EXPECT_EQ(preserve(table, wanted).values, wanted.values);
}

TEST(Gamut, EverythingMappedCanBeShown) {
    for (const double ambient : {0.0, 0.004, 0.03}) {
        SCOPED_TRACE(ambient);
        // Every pixel with its own gamut, 10% apart from its neighbours.
        const World world = synthetic::make_world(64, 48, 92, ambient);
        const CompensationTable table = bake(calibrate(world), kWhite);
        const ImageF wanted = random_colours(world, 3, 0.5);
        CompensationStats before, after;
        compensate(table, wanted, &before);
        compensate(table, preserve(table, wanted), &after);
        EXPECT_GT(before.out_of_gamut_fraction, 0.4);
        EXPECT_EQ(after.out_of_gamut_fraction, 0.0);
        EXPECT_EQ(after.invalid_fraction, 0.0);
    }
}

// What the viewer sees, after 8 bits, of colours out of gamut: hue within 3 degrees in the median.
TEST(Gamut, HueStaysWhereClippingMovesIt) {
    const World world = synthetic::make_world(64, 48, 93, 0.002);
    const ColourCalibration calibration = calibrate(world);
    const CompensationTable table = bake(calibration, kWhite);
    const ImageF wanted = random_colours(world, 4, 0.4);
    const auto median_shift = [&](GamutMapping mapping) {
        const Image8 drive =
            compensate(table, mapping == GamutMapping::preserve ? preserve(table, wanted) : wanted);
        std::vector<double> shifts;
        for (std::size_t i = 0; i < world.mixing.size(); ++i) {
            // Only colours that need moving, and whose hue means something.
            const glm::dvec3 asked = oklab_of(wanted, i);
            const glm::dvec3 n = working_from_xyz() * xyz_from_oklab(asked);
            if (chroma(asked) < 0.15 || glm::length(n) < 0.05) continue;
            const glm::dvec3 d(
                drive.values[3 * i], drive.values[3 * i + 1], drive.values[3 * i + 2]);
            const glm::dvec3 shown =
                oklab_from_xyz(world.xyz_from_camera * world.camera(i, d) / kWhite);
            if (!(chroma(shown) <= 0.02))
                shifts.push_back(worst_if_nan(hue_difference_deg(asked, shown)));
        }
        EXPECT_GT(shifts.size(), 500u);
        std::nth_element(shifts.begin(),
                         shifts.begin() + static_cast<std::ptrdiff_t>(shifts.size() / 2),
                         shifts.end());
        return shifts[shifts.size() / 2];
    };
    const double preserved = median_shift(GamutMapping::preserve);
    EXPECT_LT(preserved, 3.0);
    EXPECT_LT(preserved, 0.5 * median_shift(GamutMapping::strict));
}

// Where the knee lies and what becomes of a colour on the boundary, in closed form: untouched at
// 0.84 of the boundary, and at it 0.85 + 0.15 / 2^(1/3) = 0.96906. The boundary itself is found
// from what compensate() counts, to a thousandth.
TEST(Gamut, KneeIsAt85PercentOfTheBoundary) {
    const World world = even_world(1000, 1, 0.0);
    const CompensationTable table = bake(calibrate(world), kWhite);
    for (const double hue : {0.3, 1.7, 3.0, 4.4}) {
        SCOPED_TRACE(hue);
        const auto chroma_at = [](std::size_t i) { return 0.0005 * static_cast<double>(i); };
        const ImageF ramp = synthetic::picture(
            world, [&](std::size_t i) { return working_of(0.6, chroma_at(i), hue); });
        CompensationStats stats;
        compensate(table, ramp, &stats);
        const double boundary = chroma_at(
            static_cast<std::size_t>(std::lround((1.0 - stats.out_of_gamut_fraction) * 1000.0)));
        ASSERT_GT(boundary, 0.08);
        ASSERT_LT(boundary, 0.45);
        const ImageF wanted = synthetic::picture(world, [&](std::size_t i) {
            return working_of(0.6, boundary * (i % 2 == 0 ? 0.84 : 1.0), hue);
        });
        const ImageF mapped = preserve(table, wanted);
        EXPECT_NEAR(chroma(oklab_of(mapped, 0)) / boundary, 0.84, 1e-6);
        // The boundary was found to a step of 0.0005 in 0.08 or more.
        EXPECT_NEAR(chroma(oklab_of(mapped, 1)) / boundary, 0.96906, 0.003);
    }
}

// More chroma asked for is never less chroma shown, and lightness gives way last.
TEST(Gamut, ChromaRisesAndLightnessStays) {
    const World world = even_world(64, 36, 0.002);
    const CompensationTable table = bake(calibrate(world), kWhite);
    const ImageF wanted = synthetic::picture(world, [&](std::size_t i) {
        const double hue = static_cast<double>(i / 64) * 2.0 * std::numbers::pi / 36.0;
        return working_of(0.6, 0.5 * static_cast<double>(i % 64) / 63.0, hue);
    });
    const ImageF mapped = preserve(table, wanted);
    for (std::size_t row = 0; row < 36; ++row) {
        double before = -1.0;
        for (std::size_t x = 0; x < 64; ++x) {
            const glm::dvec3 lab = oklab_of(mapped, row * 64 + x);
            // 16 halvings and floats: 1e-5 of the chroma.
            EXPECT_GE(chroma(lab), before - 2e-5) << row << " " << x;
            EXPECT_NEAR(lab.x, 0.6, 1e-4);
            EXPECT_LE(chroma(lab), chroma(oklab_of(wanted, row * 64 + x)) + 1e-5);
            if (chroma(lab) > 0.01) {
                EXPECT_LT(hue_difference_deg(lab, oklab_of(wanted, row * 64 + x)), 0.2);
            }
            before = chroma(lab);
        }
        EXPECT_GT(before, 0.05) << row;  // and the end is a colour, not a grey
    }
}

TEST(Gamut, LightnessRisesFromTheSharedBlackToTheLocalWhite) {
    const World world = even_world(256, 2, 0.02);
    const CompensationTable table = bake(calibrate(world), kWhite);
    const double floor_lightness = make_gamut_boundary(table).floor_lightness;
    const double ambient_y = (world.xyz_from_camera * world.camera(0, glm::dvec3(0.0))).y / kWhite;
    // The ambient is not quite neutral: the darkest neutral lies at or just above its luminance.
    EXPECT_GE(floor_lightness, std::cbrt(ambient_y) * 0.99);
    EXPECT_LE(floor_lightness, std::cbrt(ambient_y) * 1.1);
    const ImageF wanted = synthetic::picture(world, [&](std::size_t i) {
        return working_of(2.0 * static_cast<double>(i % 256) / 255.0, 0.0, 0.0);
    });
    const ImageF mapped = preserve(table, wanted);
    double before = 0.0;
    for (std::size_t i = 0; i < 256; ++i) {
        const glm::dvec3 lab = oklab_of(mapped, i);
        EXPECT_GE(lab.x, before - 1e-6);
        EXPECT_GE(lab.x, floor_lightness - 1e-5);
        before = lab.x;
    }
    CompensationStats stats;
    compensate(table, mapped, &stats);
    EXPECT_EQ(stats.out_of_gamut_fraction, 0.0);
}

// Beside a part of half the brightness the boundary changes by degrees, not at one pixel.
TEST(Gamut, BoundaryIsSmoothInSpace) {
    World world = even_world(80, 24, 0.0);
    for (std::size_t i = 0; i < world.mixing.size(); ++i) {
        if (i % 80 >= 40) world.mixing[i] *= 0.5;
    }
    const CompensationTable table = bake(calibrate(world), 0.6);
    const ImageF wanted =
        synthetic::picture(world, [&](std::size_t) { return working_of(0.75, 0.35, 2.5); });
    const ImageF mapped = preserve(table, wanted);
    const std::size_t row = 12 * 80;
    const double far_bright = chroma(oklab_of(mapped, row + 5));
    const double far_dark = chroma(oklab_of(mapped, row + 75));
    const double beside = chroma(oklab_of(mapped, row + 39));
    EXPECT_GT(far_bright, far_dark * 1.05);
    EXPECT_LT(beside, far_bright - 0.3 * (far_bright - far_dark));
    CompensationStats stats;
    compensate(table, mapped, &stats);
    EXPECT_EQ(stats.out_of_gamut_fraction, 0.0);
}

TEST(Gamut, ClearSegmentsNarrowGamutIsRespected) {
    const World world = synthetic::make_world(32, 20, 94, 0.002);
    const CompensationTable table = bake(synthetic::calibrate_segment(world), kWhite);
    const ImageF wanted = random_colours(world, 5, 0.4);
    CompensationStats before, after;
    compensate(table, wanted, &before);
    compensate(table, preserve(table, wanted), &after);
    EXPECT_GT(before.out_of_gamut_fraction, 0.4);
    EXPECT_LT(after.out_of_gamut_fraction, 0.01);
}

TEST(Gamut, BadPixelsPassThroughAndNothingBecomesNan) {
    World world = synthetic::make_world(32, 20, 95, 0.002);
    world.lit[7] = false;
    const CompensationTable table = bake(calibrate(world), kWhite);
    ImageF wanted = random_colours(world, 6, 0.5);
    wanted.values[0] = std::numeric_limits<float>::quiet_NaN();
    wanted.values[4 * 3] = std::numeric_limits<float>::infinity();
    wanted.values[4 * 5 + 3] = 0.2f;
    const float extremes[] = {0.0f, 1e30f, -1e30f, -5.0f, 65504.0f, 1e-38f};
    for (std::size_t i = 0; i < 6; ++i) {
        for (std::size_t k = 0; k < 3; ++k) wanted.values[4 * (40 + i) + k] = extremes[i];
    }
    const ImageF mapped = preserve(table, wanted);
    EXPECT_TRUE(std::isnan(mapped.values[0]));
    EXPECT_TRUE(std::isinf(mapped.values[4 * 3]));
    for (std::size_t k = 0; k < 3; ++k) {
        EXPECT_EQ(mapped.values[4 * 5 + k], wanted.values[4 * 5 + k]);
        EXPECT_EQ(mapped.values[4 * 7 + k], wanted.values[4 * 7 + k]);
    }
    for (std::size_t i = 8; i < world.mixing.size(); ++i) {
        for (std::size_t k = 0; k < 4; ++k) EXPECT_TRUE(std::isfinite(mapped.values[4 * i + k]));
    }
    EXPECT_THROW(preserve(table, ImageF(31, 20, 4)), std::invalid_argument);
    EXPECT_THROW(preserve(table, ImageF(32, 20, 2)), std::invalid_argument);
}

TEST(Gamut, EmptyCalibrationMapsNothing) {
    World world = synthetic::make_world(8, 8, 96);
    world.lit.assign(world.lit.size(), false);
    const CompensationTable table = bake(calibrate(world), kWhite);
    const ImageF wanted(8, 8, 3, 7.0f);
    EXPECT_EQ(preserve(table, wanted).values, wanted.values);
}

}  // namespace
}  // namespace livery
