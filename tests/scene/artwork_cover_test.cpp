#include "scene/artwork_cover.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/random.h"
#include "core/worst_error.h"

namespace livery {
namespace {

constexpr std::uint64_t kSeed = 7;

/// Whether a point is covered, from the shape's definition.
bool is_covered(const Artwork& artwork, const glm::dvec2& at) {
    const double size = artwork.size_mm, half = 0.5 * artwork.share * size;
    const auto from_nearest = [&](double x) { return x - size * std::round(x / size); };
    switch (artwork.shape) {
        case ArtworkShape::half:
            return at.y > 0.0;
        case ArtworkShape::stripes:
            return std::abs(from_nearest(at.x)) < half;
        case ArtworkShape::checks:
            return (static_cast<long>(std::floor(at.x / size)) +
                    static_cast<long>(std::floor(at.y / size))) %
                       2 ==
                   0;
        case ArtworkShape::dots:
            return std::hypot(from_nearest(at.x), from_nearest(at.y)) < half;
        case ArtworkShape::picture:
            break;
    }
    return false;
}

/// Over a lattice of points of the parallelogram.
double counted(const Artwork& artwork, glm::dvec2 at, glm::dvec2 a, glm::dvec2 b) {
    constexpr int kSide = 200;
    int covered = 0;
    for (int j = 0; j < kSide; ++j) {
        for (int i = 0; i < kSide; ++i) {
            const double u = (i + 0.5) / kSide - 0.5, v = (j + 0.5) / kSide - 0.5;
            covered += is_covered(artwork, at + u * a + v * b) ? 1 : 0;
        }
    }
    return static_cast<double>(covered) / (kSide * kSide);
}

glm::dvec2 random_vector(Random& random, double length) {
    const double angle = 2.0 * std::numbers::pi * random.uniform();
    return length * glm::dvec2(std::cos(angle), std::sin(angle));
}

/// Largest and mean difference from counting, over footprints from a thirtieth to three times the
/// shape's size.
struct Difference {
    double largest = 0.0, mean = 0.0;
};
Difference difference_of(const Artwork& artwork, bool along_axes) {
    Random random(kSeed);
    Difference difference;
    constexpr int kCases = 400;
    for (int k = 0; k < kCases; ++k) {
        const double length = artwork.size_mm * 0.03 * std::pow(100.0, random.uniform());
        glm::dvec2 a = random_vector(random, length);
        glm::dvec2 b = random_vector(random, length * (0.2 + random.uniform()));
        if (along_axes) {
            a = {length, 0.0};
            b = {0.0, length * (0.2 + random.uniform())};
        }
        const glm::dvec2 at(artwork.size_mm * 4.0 * (random.uniform() - 0.5),
                            artwork.size_mm * 4.0 * (random.uniform() - 0.5));
        const double d = std::abs(shape_cover(artwork, at, a, b) - counted(artwork, at, a, b));
        difference.largest = worse_of(difference.largest, d);
        difference.mean += d / kCases;
    }
    std::printf("    %-8s largest %.4f mean %.5f (seed %d)\n",
                kArtworkShapes[static_cast<std::size_t>(artwork.shape)],
                difference.largest,
                difference.mean,
                static_cast<int>(kSeed));
    return difference;
}

Artwork shape_of(ArtworkShape shape, double size_mm = 12.0, double share = 0.4) {
    Artwork artwork;
    artwork.shape = shape;
    artwork.size_mm = size_mm;
    artwork.share = share;
    return artwork;
}

TEST(ShapeCover, OfOneDimensionIsExact) {
    // Counting errs by a row of its lattice, 1/200; the sides' least ratio of .02 blurs by 2% of
    // one.
    EXPECT_LT(difference_of(shape_of(ArtworkShape::half), false).largest, 0.012);
    EXPECT_LT(difference_of(shape_of(ArtworkShape::stripes), false).largest, 0.02);
    EXPECT_LT(difference_of(shape_of(ArtworkShape::stripes, 12.0, 0.05), false).largest, 0.02);
}

TEST(ShapeCover, OfTwoDimensionsIsCloseToCounting) {
    EXPECT_LT(difference_of(shape_of(ArtworkShape::checks), true).largest, 0.02);
    // Askew, both dimensions are taken as independent: seen where both edges of a check meet.
    EXPECT_LT(difference_of(shape_of(ArtworkShape::checks), false).mean, 0.01);
    // A dot's edge is taken as straight.
    EXPECT_LT(difference_of(shape_of(ArtworkShape::dots), false).mean, 0.02);
}

TEST(ShapeCover, PixelsTogetherCoverWhatTheShapeDoes) {
    for (const ArtworkShape shape :
         {ArtworkShape::stripes, ArtworkShape::checks, ArtworkShape::dots}) {
        for (const double pixel_mm : {0.7, 5.0, 30.0}) {
            const Artwork artwork = shape_of(shape);
            const glm::dvec2 a(pixel_mm, 0.1 * pixel_mm), b(-0.1 * pixel_mm, pixel_mm);
            double sum = 0.0;
            constexpr int kSide = 120;
            for (int j = 0; j < kSide; ++j) {
                for (int i = 0; i < kSide; ++i) {
                    sum += shape_cover(artwork, double(i) * a + double(j) * b, a, b);
                }
            }
            const double share = artwork.share;
            const double wanted = shape == ArtworkShape::stripes ? share
                                  : shape == ArtworkShape::checks
                                      ? 0.5
                                      : std::numbers::pi / 4.0 * share * share;
            // Dots' edges are taken as straight where they are not small beside a pixel.
            const bool straight = shape == ArtworkShape::dots && pixel_mm < 30.0;
            EXPECT_NEAR(sum / (kSide * kSide), wanted, straight ? 0.01 : 0.01 * wanted)
                << kArtworkShapes[static_cast<std::size_t>(shape)] << " at " << pixel_mm << " mm";
        }
    }
}

TEST(ShapeCover, SoftnessIsARamp) {
    Artwork artwork = shape_of(ArtworkShape::half);
    artwork.softness_mm = 10.0;
    const glm::dvec2 a(0.01, 0.0), b(0.0, 0.01);
    for (const double t : {-6.0, -4.0, 0.0, 2.5, 4.9, 7.0}) {
        const double wanted = std::clamp(0.5 + t / 10.0, 0.0, 1.0);
        EXPECT_NEAR(shape_cover(artwork, {3.0, t}, a, b), wanted, 0.002) << t;
    }
}

TEST(ShapeCover, FloatAgreesWithDoubleAndStaysWithinItsRange) {
    Random random(kSeed);
    double largest = 0.0;
    for (int k = 0; k < 200'000; ++k) {
        const Artwork artwork = shape_of(static_cast<ArtworkShape>(random.below(4)),
                                         0.1 * std::pow(1e4, random.uniform()),
                                         random.below(8) == 0 ? 0.0 : random.uniform());
        const double length = 1e-4 * std::pow(1e7, random.uniform());
        const glm::vec2 a(random_vector(random, length));
        const glm::vec2 b(random.below(10) == 0 ? glm::dvec2(0.0) : random_vector(random, length));
        const glm::vec2 at(random_vector(random, 100.0 * random.uniform()));
        const float value = shape_cover(artwork, at, a, b);
        ASSERT_TRUE(value >= 0.0f && value <= 1.0f) << value;
        const double truth = shape_cover(artwork, glm::dvec2(at), glm::dvec2(a), glm::dvec2(b));
        ASSERT_TRUE(truth >= 0.0 && truth <= 1.0) << truth;
        // A place of 100 mm has 2^-17 mm in float: an edge moves by that much of a footprint's
        // least side, under the shape's own least
        const double place = 2.0 * 8e-6 / std::max(0.02 * length, 0.002 * artwork.size_mm);
        if (std::abs(truth - static_cast<double>(value)) > place) {
            largest = worse_of(largest, std::abs(truth - static_cast<double>(value)));
        }
    }
    std::printf("    float against double, beyond a place's rounding: %.2e\n", largest);
    EXPECT_LT(largest, 4e-3) << "one of 256 levels";
}

/// Some structure at every size.
ImageF picture(int width, int height, int channels = 1) {
    ImageF image(width, height, channels);
    Random random(kSeed);
    for (float& value : image.values) value = random.uniform_float();
    for (int y = height / 4; y < height / 2; ++y) {
        for (int x = width / 3; x < width; ++x) {
            for (int c = 0; c < channels; ++c) image.at(x, y, c) = 1.0f;
        }
    }
    return image;
}

float mean_of(const ImageF& image) {
    double sum = 0.0;
    for (const float value : image.values) sum += static_cast<double>(value);
    return static_cast<float>(sum / static_cast<double>(image.values.size()));
}

TEST(FilteredPicture, KeepsAnEvenPictureEven) {
    for (const bool repeat : {false, true}) {
        const FilteredPicture filtered(ImageF(37, 53, 2, 0.6f), repeat);
        for (const double length : {1e-5, 0.01, 0.1, 0.4}) {
            float mean[2];
            filtered.mean({0.5, 0.5}, {length, 0.3 * length}, {-0.1 * length, length}, mean);
            // What lies outside of one that is not repeated begins to count at a wide footprint
            EXPECT_NEAR(mean[1], 0.6f, repeat || length < 0.2 ? 1e-5f : 0.05f) << length;
        }
    }
}

TEST(FilteredPicture, PixelsTogetherHoldWhatThePictureDoes) {
    for (const bool repeat : {false, true}) {
        for (const auto& [width, height] : {std::pair{64, 64}, {50, 70}, {1, 33}, {129, 5}}) {
            const ImageF image = picture(width, height);
            const FilteredPicture filtered(image, repeat);
            for (const int pixels : {7, 31, 200}) {
                // Pixels askew over the picture and, without repeating, its surroundings
                const double side = 1.0 / pixels;
                const int begin = repeat ? 0 : -pixels, end = repeat ? pixels : 2 * pixels;
                double sum = 0.0;
                for (int j = begin; j < end; ++j) {
                    for (int i = begin; i < end; ++i) {
                        float mean;
                        filtered.mean(
                            {(i + 0.5) * side, (j + 0.5) * side}, {side, 0.0}, {0.0, side}, &mean);
                        sum += static_cast<double>(mean) * side * side;
                    }
                }
                EXPECT_NEAR(sum, mean_of(image), 0.02)
                    << width << "x" << height << " " << pixels << (repeat ? " repeated" : "");
            }
        }
    }
}

TEST(FilteredPicture, TakesAMeanOverTheFootprintAndNoMore) {
    // Left half 0, right half 1: what a box of the footprint would see of the edge
    ImageF image(256, 256, 1);
    for (int y = 0; y < 256; ++y) {
        for (int x = 128; x < 256; ++x) image.at(x, y) = 1.0f;
    }
    const FilteredPicture filtered(image, false);
    for (const double length : {0.02, 0.1}) {
        for (const double at : {0.35, 0.45, 0.48, 0.5, 0.53, 0.6}) {
            const double wanted = std::clamp(0.5 + (at - 0.5) / length, 0.0, 1.0);
            float mean;
            filtered.mean({at, 0.5}, {length, 0.0}, {0.0, 0.01}, &mean);
            // A Gaussian of a box's variance is within .06 of it at an edge
            EXPECT_NEAR(mean, wanted, 0.07) << length << " " << at;
        }
        // Sixteen times as long down the edge as across it, as a surface seen askew: still sharp
        float mean;
        filtered.mean({0.53, 0.5}, {0.02, 0.0}, {0.0, 0.3}, &mean);
        EXPECT_GT(mean, 0.93f);
    }
}

TEST(FilteredPicture, IsEmptyOutsideAndSafeAnywhere) {
    const FilteredPicture filtered(picture(40, 30, 4), false);
    float mean[4];
    filtered.mean({1.5, 0.5}, {0.01, 0.0}, {0.0, 0.01}, mean);
    EXPECT_EQ(mean[0], 0.0f);
    Random random(kSeed);
    for (int k = 0; k < 20'000; ++k) {
        const glm::dvec2 at = random_vector(random, std::pow(10.0, 8.0 * random.uniform() - 4.0));
        const double length = std::pow(10.0, 12.0 * random.uniform() - 8.0);
        filtered.mean(at, random_vector(random, length), random_vector(random, 1e-9), mean);
        for (const float value : mean) ASSERT_TRUE(value >= 0.0f && value <= 1.001f) << value;
    }
}

}  // namespace
}  // namespace livery
