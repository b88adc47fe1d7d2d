// How far a picture is from the truth.
#include "support/radiance_error.h"

#include <limits>
#include <stdexcept>

#include <gtest/gtest.h>

namespace livery {
namespace {

TEST(RadianceErrorTest, TellsQuantilesOfTheLargestChannel) {
    const ImageF truth(101, 1, 4, 1.0f);
    ImageF drawn = truth;
    for (int x = 0; x < 101; ++x) {
        drawn.at(x, 0, x % 3) = 1.0f + (x % 2 == 0 ? 0.01f : -0.01f) * static_cast<float>(x);
    }
    drawn.at(100, 0, 3) = 0.25f;  // covered by less than half
    const RadianceError error = radiance_error(drawn, truth);
    EXPECT_EQ(error.pixels, 100u);
    EXPECT_NEAR(error.median, 0.5, 1e-6);
    EXPECT_NEAR(error.largest, 0.99, 1e-6);
    EXPECT_THROW(radiance_error(truth, ImageF(100, 1, 4)), std::invalid_argument);
}

TEST(RadianceErrorTest, APixelThatIsNoNumberIsTheWorst) {
    const ImageF truth(200, 1, 4, 1.0f);
    for (const int at : {0, 77, 199}) {
        for (int channel = 0; channel < 3; ++channel) {
            ImageF drawn = truth;
            drawn.at(at, 0, channel) = std::numeric_limits<float>::quiet_NaN();
            const RadianceError error = radiance_error(drawn, truth);
            EXPECT_EQ(error.median, 0.0);
            EXPECT_EQ(error.p99, 0.0);
            EXPECT_EQ(error.largest, std::numeric_limits<double>::infinity());
            EXPECT_FALSE(error.mean_signed < 1e9 && error.mean_signed > -1e9);
        }
    }
}

}  // namespace
}  // namespace livery
