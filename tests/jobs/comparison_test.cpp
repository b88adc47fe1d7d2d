#include "jobs/comparison.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "core/colour.h"

namespace livery {
namespace {

/// Four pixels in a row with one XYZ each.
ImageF row(const std::vector<glm::dvec3>& xyz) {
    ImageF image(static_cast<int>(xyz.size()), 1, 3);
    for (std::size_t i = 0; i < xyz.size(); ++i) {
        for (int c = 0; c < 3; ++c) {
            image.at(static_cast<int>(i), 0, c) = static_cast<float>(xyz[i][c]);
        }
    }
    return image;
}

Image8 mask(const std::vector<int>& values) {
    Image8 image(static_cast<int>(values.size()), 1, 1);
    for (std::size_t i = 0; i < values.size(); ++i) {
        image.values[i] = static_cast<std::uint8_t>(values[i]);
    }
    return image;
}

TEST(Comparison, APixelThatIsNoNumberIsTheWorst) {
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
    for (std::size_t at = 0; at <= 20; ++at) {
        std::vector<float> errors(20, 1.0f);
        errors.insert(errors.begin() + static_cast<std::ptrdiff_t>(at), kNan);
        const ErrorStatistics statistics = statistics_of(errors);
        EXPECT_EQ(statistics.pixels, 21u);
        EXPECT_EQ(statistics.median, 1.0);
        EXPECT_EQ(statistics.p95, 1.0);
        EXPECT_EQ(statistics.worst, std::numeric_limits<double>::infinity());
        EXPECT_FALSE(statistics.mean < 1e9);
    }
    const glm::dvec3 grey = 10.0 * d65_xyz();
    const Image8 all = mask({255, 255, 255}), none = mask({0, 0, 0});
    const Comparison result = compare_xyz(row({grey, grey, grey}),
                                          row({grey, glm::dvec3(std::nan("")), grey}),
                                          40.0 * d65_xyz(),
                                          {all, none, all, all});
    EXPECT_EQ(result.interior.worst, std::numeric_limits<double>::infinity());
    EXPECT_EQ(result.interior.median, 0.0);
}

TEST(Comparison, SortsPixelsByKind) {
    const glm::dvec3 white = 40.0 * d65_xyz();
    const glm::dvec3 grey = 10.0 * d65_xyz();
    const ImageF wanted = row({grey, grey, grey, grey, grey, grey});
    const ImageF shown = row({grey, 1.1 * grey, 1.2 * grey, 0.0 * grey, 0.5 * grey, 2.0 * grey});
    ComparisonMasks masks;
    masks.lit = mask({255, 255, 255, 255, 255, 0});
    masks.edge = mask({0, 0, 255, 0, 0, 0});
    masks.valid = mask({255, 255, 255, 0, 255, 255});
    masks.reachable = mask({255, 255, 255, 255, 0, 255});
    masks.predicted = mask({0, 255, 255, 0, 255, 0});
    const Comparison result = compare_xyz(wanted, shown, white, masks);
    EXPECT_EQ(result.interior.pixels, 2u);
    EXPECT_NEAR(result.interior.median, 0.0, 1e-4);
    const double ten_percent =
        ciede2000(lab_from_xyz(grey, white), lab_from_xyz(1.1 * grey, white));
    EXPECT_NEAR(result.interior.p95, ten_percent, 1e-4);
    EXPECT_EQ(result.edge.pixels, 1u);
    EXPECT_EQ(result.clipped.pixels, 1u);
    EXPECT_EQ(result.reachable_with_masked.pixels, 3u);
    // The masked pixel is black: the whole lightness is lost.
    EXPECT_GT(result.reachable_with_masked.worst, 30.0);
    EXPECT_DOUBLE_EQ(result.reachable_fraction, 4.0 / 5.0);
    EXPECT_DOUBLE_EQ(result.valid_fraction, 2.0 / 3.0);
    EXPECT_DOUBLE_EQ(result.masked_fraction, 1.0 / 5.0);
    // Interior and edge band together, without what is out of reach.
    EXPECT_EQ(result.predicted.pixels, 2u);
    EXPECT_NEAR(result.predicted.median, ten_percent, 1e-4);
    EXPECT_DOUBLE_EQ(result.predicted_fraction, 3.0 / 5.0);
    EXPECT_TRUE(std::isnan(result.de00.at(5, 0)));
}

TEST(Comparison, PercentilesAreNearestRank) {
    std::vector<float> errors;
    for (int k = 1; k <= 100; ++k) errors.push_back(static_cast<float>(k));
    const ErrorStatistics statistics = statistics_of(errors);
    EXPECT_DOUBLE_EQ(statistics.median, 50.0);
    EXPECT_DOUBLE_EQ(statistics.p95, 95.0);
    EXPECT_DOUBLE_EQ(statistics.mean, 50.5);
    EXPECT_DOUBLE_EQ(statistics.worst, 100.0);
    EXPECT_EQ(statistics_of({}).pixels, 0u);
}

TEST(Comparison, WantedPictureKeepsItsScale) {
    ImageF wanted(1, 1, 4, 1.0f);
    const ImageF xyz = xyz_from_wanted(wanted, 25.0);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(xyz.at(0, 0, c), 25.0 * d65_xyz()[c], 1e-4);
}

TEST(Comparison, RefusesPicturesOfUnequalSize) {
    const ImageF two(2, 1, 3), three(3, 1, 3);
    const Image8 both(2, 1, 1);
    EXPECT_THROW(compare_xyz(two, three, d65_xyz(), {both, both, both, both}),
                 std::invalid_argument);
}

}  // namespace
}  // namespace livery
