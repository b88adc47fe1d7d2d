#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "core/pictures/picture_means.h"

namespace livery {
namespace {

ImageF filled(int width, int height, float value) {
    ImageF picture(width, height, 4, value);
    for (std::size_t i = 3; i < picture.values.size(); i += 4) picture.values[i] = 1.0f;
    return picture;
}

TEST(SquareMeans, CountEachPixelAsMuchAsItIsCovered) {
    ImageF picture = filled(4, 2, 0.0f);
    // Of the left square: one whole pixel, one half covered, two not at all, whatever they hold
    const float colours[] = {1.0f, 4.0f, 100.0f, std::numeric_limits<float>::quiet_NaN()};
    const float coverages[] = {1.0f, 0.5f, 0.0f, 0.0f};
    for (int k = 0; k < 4; ++k) {
        for (int c = 0; c < 3; ++c) picture.at(k % 2, k / 2, c) = colours[k];
        picture.at(k % 2, k / 2, 3) = coverages[k];
        picture.at(2 + k % 2, k / 2, 1) = static_cast<float>(k);
    }
    const ImageF means = square_means(picture, 2);
    ASSERT_EQ(means.width, 2);
    ASSERT_EQ(means.height, 1);
    for (int c = 0; c < 3; ++c) EXPECT_FLOAT_EQ(means.at(0, 0, c), 2.0f) << c;
    EXPECT_FLOAT_EQ(means.at(0, 0, 3), 0.375f);
    EXPECT_FLOAT_EQ(means.at(1, 0, 0), 0.0f);
    EXPECT_FLOAT_EQ(means.at(1, 0, 1), 1.5f);
    EXPECT_FLOAT_EQ(means.at(1, 0, 3), 1.0f);
}

TEST(SquareMeans, LeaveOutWhatIsNoWholeSquare) {
    ImageF picture = filled(7, 5, 2.0f);
    for (int y = 0; y < 5; ++y) picture.at(6, y, 0) = 1e9f;
    const ImageF means = square_means(picture, 3);
    ASSERT_EQ(means.width, 2);
    ASSERT_EQ(means.height, 1);
    for (int x = 0; x < 2; ++x) EXPECT_FLOAT_EQ(means.at(x, 0, 0), 2.0f);
    EXPECT_EQ(square_means(picture, 1).values, picture.values);
    EXPECT_TRUE(square_means(picture, 8).values.empty());
}

TEST(SquareMeans, HideNothingThatIsNoNumber) {
    ImageF picture = filled(4, 2, 1.0f);
    picture.at(1, 1, 2) = std::numeric_limits<float>::quiet_NaN();
    const ImageF means = square_means(picture, 2);
    EXPECT_TRUE(std::isnan(means.at(0, 0, 2)));
    EXPECT_FLOAT_EQ(means.at(0, 0, 1), 1.0f);
    EXPECT_FLOAT_EQ(means.at(1, 0, 2), 1.0f);
}

TEST(SquareMeans, WantCoverageAndASide) {
    EXPECT_THROW(square_means(ImageF(4, 4, 3), 2), std::invalid_argument);
    EXPECT_THROW(square_means(ImageF(4, 4, 4), 0), std::invalid_argument);
}

}  // namespace
}  // namespace livery
