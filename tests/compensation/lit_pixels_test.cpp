// What surrounds the known pixels: borders fade, small holes close, single pixels do not sparkle.
#include "compensation/lit_pixels.h"

#include <algorithm>
#include <functional>

#include <gtest/gtest.h>

#include "compensation/compensation.h"
#include "compensation/synthetic.h"
#include "compensation/white_segment.h"
#include "core/worst_error.h"
#include "support/message_of.h"

namespace livery {
namespace {

using synthetic::calibrate;
using synthetic::make_world;
using synthetic::World;

constexpr double kBorderWhiteY = 0.3;

Image8 status_where(int width, int height, const std::function<bool(int, int)>& known) {
    Image8 status(width, height, 1);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            if (known(x, y)) status.at(x, y) = static_cast<std::uint8_t>(PixelStatus::measured);
        }
    }
    return status;
}

/// Of every pixel, 0 where none is sent.
ImageF light_of(const Image8& status) {
    const LitPixels lit = lit_pixels(status);
    EXPECT_EQ(lit.pixels.size(), lit.light.size());
    EXPECT_TRUE(std::is_sorted(lit.pixels.begin(), lit.pixels.end()));
    ImageF light(status.width, status.height, 1);
    for (std::size_t i = 0; i < lit.pixels.size(); ++i) {
        EXPECT_GT(lit.light[i], 0.0f);
        EXPECT_LE(lit.light[i], 1.0f);
        light.values[lit.pixels[i]] = lit.light[i];
    }
    return light;
}

void forget(World& world, const std::function<bool(int, int)>& unknown) {
    for (int y = 0; y < world.height; ++y) {
        for (int x = 0; x < world.width; ++x) {
            if (unknown(x, y)) world.lit[static_cast<std::size_t>(y * world.width + x)] = false;
        }
    }
}

/// Without the noise that make_world() gives to each pixel.
World even_world(int width, int height) {
    World world = make_world(width, height, 3);
    const glm::dmat3 mixing = world.mixing.front();
    for (glm::dmat3& one : world.mixing) one = mixing;
    return world;
}

TEST(LitPixels, AStraightBorderFadesOverFourPixelsAndDimsNothingKnown) {
    const ImageF light = light_of(status_where(30, 20, [](int x, int) { return x < 15; }));
    for (int y = 0; y < 20; ++y) {
        for (int x = 0; x < 15; ++x) EXPECT_EQ(light.at(x, y), 1.0f) << x;
        const float expected[] = {1.0f, 0.72f, 0.36f, 0.12f, 0.0f};
        for (int k = 0; k < 5; ++k) EXPECT_NEAR(light.at(15 + k, y), expected[k], 1e-6f) << k;
    }
}

TEST(LitPixels, ThePicturesOwnBorderIsNone) {
    const ImageF whole = light_of(status_where(12, 9, [](int, int) { return true; }));
    for (const float light : whole.values) EXPECT_EQ(light, 1.0f);
    // The corner of a picture fades as its middle does.
    const ImageF half = light_of(status_where(40, 30, [](int x, int) { return x < 20; }));
    for (int x = 0; x < 40; ++x) EXPECT_EQ(half.at(x, 0), half.at(x, 15)) << x;
}

TEST(LitPixels, JagsOfABorderAreAveraged) {
    for (const int period : {2, 3, 4, 5, 6}) {
        SCOPED_TRACE(period);
        const auto tooth = [&](int y) { return y % period < period / 2 ? 4 : 0; };
        const Image8 status = status_where(40, 60, [&](int x, int y) { return x < 20 + tooth(y); });
        const ImageF light = light_of(status);
        for (int x = 0; x < 40; ++x) {
            float least = 1.0f, most = 0.0f;
            for (int y = 10; y < 50; ++y) {
                least = std::min(least, light.at(x, y));
                most = std::max(most, light.at(x, y));
            }
            EXPECT_LT(most - least, 0.07f) << x;
        }
    }
}

TEST(LitPixels, SmallHolesAndCracksAreClosedAndLargeOnesAreNot) {
    for (const int side : {1, 3, 5, 12}) {
        SCOPED_TRACE(side);
        const ImageF hole = light_of(status_where(40, 40, [&](int x, int y) {
            return x < 14 || x >= 14 + side || y < 14 || y >= 14 + side;
        }));
        const float least = *std::min_element(hole.values.begin(), hole.values.end());
        EXPECT_EQ(least, side <= 5 ? 1.0f : 0.0f);
    }
    for (const int width : {1, 4, 6}) {
        SCOPED_TRACE(width);
        const ImageF crack =
            light_of(status_where(40, 40, [&](int x, int) { return x < 14 || x >= 14 + width; }));
        const float least = *std::min_element(crack.values.begin(), crack.values.end());
        EXPECT_EQ(least == 1.0f, width <= 4) << least;
    }
}

TEST(LitPixels, AKnownPixelAloneDoesNotSparkle) {
    const ImageF light =
        light_of(status_where(30, 30, [](int x, int y) { return x == 15 && y == 15; }));
    EXPECT_NEAR(light.at(15, 15), 0.12f, 1e-6f);
    // It is a faint spot without an edge.
    EXPECT_GT(light.at(16, 15), 0.75f * light.at(15, 15));
    EXPECT_EQ(*std::max_element(light.values.begin(), light.values.end()), light.at(15, 15));
    // A thin part that is known keeps its light.
    const ImageF strip =
        light_of(status_where(30, 30, [](int x, int) { return x == 15 || x == 16; }));
    for (int y = 0; y < 30; ++y) EXPECT_EQ(strip.at(15, y), 1.0f);
}

TEST(LitPixels, AHoleTakesWhatLiesAroundIt) {
    World world = even_world(30, 30);
    for (int y = 0; y < 30; ++y) {
        for (int x = 0; x < 30; ++x) {
            world.mixing[static_cast<std::size_t>(30 * y + x)] *= 1.0 + 0.01 * x;
        }
    }
    const ColourCalibration whole = calibrate(world);
    forget(world, [](int x, int y) { return x > 12 && x < 16 && y > 12 && y < 16; });
    const ColourCalibration holed = calibrate(world);
    for (int y = 13; y < 16; ++y) {
        for (int x = 13; x < 16; ++x) {
            const auto pixel = static_cast<std::size_t>(30 * y + x);
            const PixelCorrection truth = correction_of(whole, pixel);
            const PixelCorrection found = correction_of(holed, pixel);
            for (std::size_t k = 0; k < 3; ++k) {
                // It changes by 1% of itself a pixel at most, and the mean follows.
                EXPECT_NEAR(found.span[k] / truth.span[k], 1.0f, 0.01f) << x << ", " << y;
                EXPECT_NEAR(found.dark[k] / truth.dark[k], 1.0f, 0.01f);
            }
            for (std::size_t k = 0; k < 9; ++k) {
                EXPECT_NEAR(found.unmixing[k], truth.unmixing[k], 1e-5f);
            }
        }
    }
}

TEST(LitPixels, AcrossASilhouetteTheNearerSideDecides) {
    World world = even_world(30, 12);
    for (int y = 0; y < 12; ++y) {
        for (int x = 16; x < 30; ++x) world.mixing[static_cast<std::size_t>(30 * y + x)] *= 0.25;
    }
    forget(world, [](int x, int) { return x >= 14 && x < 18; });
    const ColourCalibration calibration = calibrate(world);
    const auto span = [&](int x) {
        return correction_of(calibration, static_cast<std::size_t>(30 * 6 + x)).span[1];
    };
    EXPECT_NEAR(span(14) / span(13), 1.0f, 0.08f);
    EXPECT_LT(span(17) / span(18), 1.6f);
    EXPECT_GT(span(15), span(16));
}

/// Light of the projector alone that a drive gives in units of a full one's, mean of the channels.
double relative_light(const World& world, const std::uint8_t* drive, const std::uint8_t* full) {
    const glm::dvec3 black = world.light(glm::dvec3(0.0));
    const glm::dvec3 here = world.light({drive[0], drive[1], drive[2]}) - black;
    const glm::dvec3 there = world.light({full[0], full[1], full[2]}) - black;
    return (here.x / there.x + here.y / there.y + here.z / there.z) / 3.0;
}

TEST(LitPixels, TheProjectorsLightFadesInProportion) {
    World world = even_world(40, 24);
    const ColourCalibration whole = calibrate(world);
    forget(world, [](int x, int) { return x >= 20; });
    const ColourCalibration half = calibrate(world);
    const ImageF wanted = synthetic::picture(
        world, [&](std::size_t i) { return world.wanted(i, glm::dvec3(200.0), kBorderWhiteY); });
    for (const GamutMapping gamut : {GamutMapping::strict, GamutMapping::preserve}) {
        const Image8 full = compensate(bake(whole, kBorderWhiteY, gamut), wanted);
        CompensationStats stats;
        const Image8 faded = compensate(bake(half, kBorderWhiteY, gamut), wanted, &stats);
        for (int y = 0; y < 24; ++y) {
            for (int x = 0; x < 20; ++x) {
                for (int k = 0; k < 3; ++k) EXPECT_EQ(faded.at(x, y, k), full.at(x, y, k));
            }
        }
        const double expected[] = {1.0, 0.72, 0.36, 0.12};
        for (int k = 0; k < 4; ++k) {
            double sum = 0.0;
            for (int y = 0; y < 24; ++y) {
                sum += relative_light(world, faded.pixel(20 + k, y), full.pixel(20 + k, y));
            }
            // Levels of 8 bits at drives of 80 and more: 2.5% each, 24 of them with the dither
            EXPECT_NEAR(sum / 24.0 / expected[k], 1.0, 0.01) << k;
        }
        for (int k = 0; k < 3; ++k) EXPECT_EQ(faded.at(24, 12, k), 0);
        EXPECT_DOUBLE_EQ(stats.invalid_fraction, 16.0 / 40.0);
    }
}

TEST(LitPixels, OfAProjectorThatDoesNotAddUpLightFadesToo) {
    World world = even_world(40, 24);
    const ColourCalibration whole = synthetic::calibrate_segment(world, 17);
    forget(world, [](int x, int) { return x >= 20; });
    const ColourCalibration half = synthetic::calibrate_segment(world, 17);
    const ImageF wanted(40, 24, 3, 0.5f);
    const Image8 full = compensate(bake(whole, 0.5), wanted);
    const Image8 faded = compensate(bake(half, 0.5), wanted);
    const double black = synthetic::segment_light(world, glm::dvec3(0.0)).y;
    const auto green = [&](const Image8& picture, int x) {
        double sum = 0.0;
        for (int y = 0; y < 24; ++y) {
            const std::uint8_t* d = picture.pixel(x, y);
            sum += synthetic::segment_light(world, {d[0], d[1], d[2]}).y - black;
        }
        return sum;
    };
    EXPECT_NEAR(green(faded, 20) / green(full, 20), 1.0, 0.02);
    EXPECT_NEAR(green(faded, 21) / green(full, 21), 0.72, 0.02);
    EXPECT_NEAR(green(faded, 22) / green(full, 22), 0.36, 0.02);
}

TEST(PixelShares, AddUpAndTellWhatBecomesOfEachPixel) {
    ColourCalibration c = calibrate(even_world(40, 20));
    const auto set = [&](int x, int y, PixelStatus status) {
        c.status.at(x, y) = static_cast<std::uint8_t>(status);
    };
    for (int y = 0; y < 20; ++y) {
        for (int x = 0; x < 40; ++x) {
            set(x,
                y,
                x < 10   ? PixelStatus::predicted
                : x < 20 ? PixelStatus::measured
                : x < 30 ? PixelStatus::not_decoded
                         : PixelStatus::unlit);
        }
    }
    set(15, 10, PixelStatus::edge);
    // Of 30 lit columns: one of the border in full, three faded, six black
    const PixelShares lit = pixel_shares(c, {});
    EXPECT_DOUBLE_EQ(lit.predicted, 200.0 / 600.0);
    EXPECT_DOUBLE_EQ(lit.measured, 199.0 / 600.0);
    EXPECT_DOUBLE_EQ(lit.interpolated, 21.0 / 600.0);
    EXPECT_DOUBLE_EQ(lit.faded, 60.0 / 600.0);
    EXPECT_DOUBLE_EQ(lit.black, 120.0 / 600.0);
    EXPECT_EQ(text_of(lit),
              "33.2% measured, 33.3% predicted, 3.5% interpolated, 10.0% faded, 20.0% black");
    const PixelShares of_mask =
        pixel_shares(c, status_where(40, 20, [](int x, int) { return x >= 19; }));
    EXPECT_DOUBLE_EQ(of_mask.measured, 1.0 / 21.0);
    EXPECT_DOUBLE_EQ(of_mask.black, 16.0 / 21.0);
    const PixelShares of_none = pixel_shares(c, Image8(40, 20, 1));
    EXPECT_EQ(
        of_none.measured + of_none.predicted + of_none.interpolated + of_none.faded + of_none.black,
        0.0);
    EXPECT_EQ(message_of([&] { pixel_shares(c, Image8(39, 20, 1)); }),
              "pixel_shares: a mask of 39x20 with 1 channels, the calibration has 40x20");
}

}  // namespace
}  // namespace livery
