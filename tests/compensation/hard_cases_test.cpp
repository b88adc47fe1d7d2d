// Projectors and surfaces at which the correction is badly conditioned: it stays defined, is as
// right as float can be, and what it cannot show is counted or refused with a reason.
#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

#include "compensation/compensation.h"
#include "compensation/synthetic.h"
#include "core/worst_error.h"

namespace livery {
namespace {

using synthetic::World;

struct Recovered {
    std::array<double, 3> worst{};  ///< levels, of each channel
    CompensationStats stats;
};

/// Drives that are asked for by the light that they make, and come back.
Recovered recovered(const World& world, double low, double white_y) {
    Random random(61);
    std::vector<glm::dvec3> drives;
    const ImageF wanted = synthetic::picture(world, [&](std::size_t i) {
        drives.push_back(synthetic::random_drive(random, low, 250.0));
        return world.wanted(i, drives.back(), white_y);
    });
    Recovered result;
    const Image8 out =
        compensate(bake(synthetic::calibrate(world), white_y), wanted, &result.stats);
    for (std::size_t i = 0; i < drives.size(); ++i) {
        for (std::size_t k = 0; k < 3; ++k) {
            const double off =
                static_cast<double>(out.values[3 * i + k]) - drives[i][static_cast<int>(k)];
            result.worst[k] = worse_of(result.worst[k], std::abs(off));
        }
    }
    return result;
}

/// Every colour of a cube far around what can be shown has an answer with both mappings, and counts
/// that are shares.
void expect_defined(const ColourCalibration& calibration, double white_y) {
    Random random(62);
    ImageF wanted(calibration.width, calibration.height, 4, 1.0f);
    for (std::size_t i = 0; i < wanted.pixel_count(); ++i) {
        for (std::size_t c = 0; c < 3; ++c) {
            wanted.values[4 * i + c] = static_cast<float>(6.0 * random.uniform() - 2.0);
        }
    }
    for (const GamutMapping mapping : {GamutMapping::strict, GamutMapping::preserve}) {
        CompensationStats stats;
        compensate(bake(calibration, white_y, mapping), wanted, &stats);
        EXPECT_EQ(stats.invalid_fraction, 0.0);
        EXPECT_GT(stats.out_of_gamut_fraction, 0.5);
        EXPECT_LE(stats.out_of_gamut_fraction, 1.0);
    }
}

TEST(HardCompensation, ChannelsOfOneToAThousandComeBack) {
    World world = synthetic::make_world(97, 61, 41, 1e-5);
    for (glm::dmat3& mixing : world.mixing) {
        mixing[1] *= 0.03;
        mixing[2] *= 1e-3;
    }
    const Recovered result = recovered(world, 64.0, 0.2);
    // Rounding with dither moves by less than one level, the curve by under 0.3. A thousandth of
    // the light is told in float to 6e-5 of itself, several times over: 0.1 level at most.
    for (const double worst : result.worst) EXPECT_LT(worst, 1.5);
    EXPECT_EQ(result.stats.invalid_fraction, 0.0);
    EXPECT_EQ(result.stats.out_of_gamut_fraction, 0.0);
    expect_defined(synthetic::calibrate(world), 0.2);
}

TEST(HardCompensation, MixingOfConditionTenThousandComesBackAsFarAsFloatTellsColours) {
    // Three primaries that are nearly one
    World world = synthetic::make_world(97, 61, 42);
    for (glm::dmat3& mixing : world.mixing) {
        const glm::dvec3 mean = (mixing[0] + mixing[1] + mixing[2]) / 3.0;
        for (int k = 0; k < 3; ++k) mixing[k] = mean + 3e-4 * (mixing[k] - mean);
    }
    const Recovered result = recovered(world, 64.0, 0.4);
    // A wanted colour and the table have 6e-8 of 1, which is 6e-4 of N and more, a few times over:
    // 0.35 of a level each at drive 64
    for (const double worst : result.worst) EXPECT_LT(worst, 1.3 + 4 * 0.35);
    EXPECT_EQ(result.stats.invalid_fraction, 0.0);
    expect_defined(synthetic::calibrate(world), 0.4);
}

TEST(HardCompensation, AResponseThatIsFlatOverHalfOfItsRangeIsNeverSentThere) {
    const World world = synthetic::make_world(97, 61, 43, 0.0);
    for (const bool dark_half : {true, false}) {
        SCOPED_TRACE(dark_half ? "no light below 128" : "no more light above 128");
        ColourCalibration calibration = synthetic::calibrate(world);
        for (ResponseCurve& curve : calibration.response) {
            const auto last = static_cast<double>(curve.drive_from_n.size() - 1);
            for (std::size_t i = 0; i < curve.drive_from_n.size(); ++i) {
                const double half = 127.0 * std::pow(static_cast<double>(i) / last, 1.0 / 2.2);
                curve.drive_from_n[i] = static_cast<float>(dark_half ? 128.0 + half : half);
            }
            if (dark_half) curve.drive_from_n.front() = 0.0f;
        }
        Random random(63);
        const ImageF wanted = synthetic::picture(world, [&](std::size_t i) {
            return world.wanted(i, synthetic::random_drive(random, 100.0, 250.0), 0.4);
        });
        CompensationStats stats;
        const Image8 out = compensate(bake(calibration, 0.4), wanted, &stats);
        EXPECT_EQ(stats.invalid_fraction, 0.0);
        EXPECT_EQ(stats.out_of_gamut_fraction, 0.0);
        for (const std::uint8_t level : out.values) {
            if (dark_half) {
                ASSERT_GE(level, 127);
            } else {
                ASSERT_LE(level, 128);
            }
        }
        expect_defined(calibration, 0.4);
    }
}

TEST(HardCompensation, BlackAboveWhiteIsRefusedByNameAndARoomBrighterThanWhiteIsCounted) {
    const World dark = synthetic::make_world(8, 4, 44);
    for (const float span : {0.0f, -0.25f}) {
        ColourCalibration calibration = synthetic::calibrate(dark);
        calibration.span.at(5, 2, 1) = span;
        try {
            bake(calibration, 0.3);
            ADD_FAILURE() << span;
        } catch (const std::invalid_argument& error) {
            EXPECT_NE(std::string(error.what()).find("(5, 2)"), std::string::npos) << error.what();
        }
    }
    // White on top of a room ten times as bright: all that is wanted is too dark
    const World bright = synthetic::make_world(8, 4, 44, 10.0);
    for (const GamutMapping mapping : {GamutMapping::strict, GamutMapping::preserve}) {
        CompensationStats stats;
        const Image8 out = compensate(
            bake(synthetic::calibrate(bright), 0.3, mapping), ImageF(8, 4, 3, 0.5f), &stats);
        EXPECT_EQ(stats.invalid_fraction, 0.0);
        EXPECT_EQ(stats.clipped_low_fraction, 1.0);
        EXPECT_EQ(stats.out_of_gamut_fraction, 1.0);
        EXPECT_EQ(*std::max_element(out.values.begin(), out.values.end()), 0);
    }
}

}  // namespace
}  // namespace livery
