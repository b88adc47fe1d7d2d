#include "live/vote_frames.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/colour.h"
#include "core/error.h"

namespace livery {
namespace {

/// The left half covered with one colour.
ImageF half_covered(const glm::dvec3& working) {
    ImageF picture(8, 4, 4);
    for (int y = 0; y < 4; ++y) {
        for (int x = 0; x < 4; ++x) {
            for (int c = 0; c < 3; ++c) picture.at(x, y, c) = static_cast<float>(working[c]);
            picture.at(x, y, 3) = 1.0f;
        }
    }
    return picture;
}

TEST(VoteFrames, LuminanceIsThatOfTheCoveredPixels) {
    EXPECT_NEAR(mean_luminance(half_covered(glm::dvec3(0.4))), 0.4, 1e-6);
    // Rec.709's green by its definition.
    const glm::dvec3 green = working_from_rec709() * glm::dvec3(0.0, 1.0, 0.0);
    EXPECT_NEAR(mean_luminance(half_covered(green)), 0.7152, 2e-4);
    ImageF two = half_covered(glm::dvec3(0.2));
    for (int y = 0; y < 4; ++y) {
        for (int x = 0; x < 2; ++x) two.at(x, y, 0) = two.at(x, y, 1) = two.at(x, y, 2) = 0.8f;
    }
    EXPECT_NEAR(mean_luminance(two), 0.5, 1e-6);
    EXPECT_EQ(mean_luminance(ImageF(8, 4, 4)), 0.0);
    EXPECT_THROW(mean_luminance(ImageF(8, 4, 3)), std::invalid_argument);
}

TEST(VoteFrames, GreyIsNeutralAsBrightAsAskedForAndOnlyOnTheMockUp) {
    const ImageF look = half_covered({0.9, 0.1, 0.3});
    for (const double luminance : {0.0, 0.05, 0.214, 0.5, 1.0}) {
        const Image8 grey = neutral_drive(look, luminance, ProjectorSetup());
        // IEC 61966-2-1
        const double srgb = luminance <= 0.0031308 ? 12.92 * luminance
                                                   : 1.055 * std::pow(luminance, 1 / 2.4) - 0.055;
        for (int y = 0; y < 4; ++y) {
            for (int x = 0; x < 8; ++x) {
                const double wanted = x < 4 ? 255.0 * srgb : 0.0;
                for (int c = 0; c < 3; ++c) EXPECT_NEAR(grey.at(x, y, c), wanted, 1.0);
            }
        }
    }
}

}  // namespace
}  // namespace livery
