// Half floats, whole levels and the artwork's filter on pictures whose answer is known.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include <gtest/gtest.h>

#include "compensation/compensate.h"
#include "core/pictures/picture_means.h"
#include "core/statistics.h"
#include "core/worst_error.h"
#include "gl/context.h"
#include "jobs/synthetic_calibration.h"
#include "ledger/accuracy/chain_artwork.h"
#include "ledger/accuracy/chain_precision.h"
#include "radiance/renderer.h"
#include "support/small_meshes.h"

namespace livery {
namespace {

CompensationTable table_of(int width, int height) {
    return bake(synthetic_calibration(ImageF(width, height, 1, 1.0f)), 0.5);
}

/// Dark to middle greys, a little warm.
ImageF ramp(int width, int height, float from, float to) {
    ImageF picture(width, height, 4, 1.0f);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const float share = (static_cast<float>(x) + 0.5f) / static_cast<float>(width);
            const float grey = from + share * (to - from);
            picture.at(x, y, 0) = 1.1f * grey;
            picture.at(x, y, 1) = grey;
            picture.at(x, y, 2) = 0.9f * grey;
        }
    }
    return picture;
}

TEST(WholeLevels, AreTheExactDriveToHalfALevelAndToOneWithDither) {
    const CompensationTable table = table_of(128, 32);
    const ImageF wanted = ramp(128, 32, 0.01f, 0.6f);
    const ImageF exact = exact_drive(table, wanted);
    const Image8 rounded = rounded_drive(exact), dithered = compensate(table, wanted);
    for (int y = 0; y < 32; ++y) {
        for (int x = 0; x < 128; ++x) {
            const float threshold =
                dither_of(static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y)) + 0.5f;
            for (int c = 0; c < 3; ++c) {
                const float drive = exact.at(x, y, c);
                EXPECT_LE(std::abs(drive - static_cast<float>(rounded.at(x, y, c))), 0.5f);
                // What is sent is what the dither cuts the exact drive to; next to a whole level
                // two ways to add up floats may fall on either side
                const float sum = drive + threshold;
                if (std::abs(sum - std::round(sum)) < 1e-3f) continue;
                EXPECT_EQ(static_cast<int>(dithered.at(x, y, c)), static_cast<int>(sum))
                    << x << " " << y << " " << c;
            }
        }
    }
}

TEST(WholeLevels, OfWholeDrivesLoseNothing) {
    const CompensationTable table = table_of(16, 8);
    ImageF exact(16, 8, 3);
    for (std::size_t i = 0; i < exact.values.size(); ++i) {
        exact.values[i] = static_cast<float>(20 + (7 * i) % 200);
    }
    for (const int side_px : {1, 4}) {
        const auto errors = drive_errors(table, rounded_drive(exact), exact, side_px);
        EXPECT_EQ(errors.size(), 16u * 8u / static_cast<std::size_t>(side_px * side_px));
        for (const float error : errors) EXPECT_LT(error, 1e-3f);
    }
}

TEST(WholeLevels, WithDitherAreNearerFromAfar) {
    const CompensationTable table = table_of(256, 32);
    const ImageF wanted = ramp(256, 32, 0.02f, 0.06f);
    const ImageF exact = exact_drive(table, wanted);
    const auto error_of = [&](const Image8& drive, int side_px) {
        return static_cast<double>(median(drive_errors(table, drive, exact, side_px)));
    };
    const Image8 rounded = rounded_drive(exact), dithered = compensate(table, wanted);
    EXPECT_GT(error_of(rounded, 1), 0.0);
    EXPECT_GT(error_of(dithered, 1), error_of(rounded, 1)) << "a dither adds up to another half";
    EXPECT_LT(error_of(dithered, 4), 0.5 * error_of(rounded, 4));
}

AccuracyScene lit_ball() {
    AccuracyScene scene;
    Product product;
    product.mesh = make_sphere({0, 0, 0}, 10.0, 32, "body");
    product.exchange = part_exchange(product.mesh);
    scene.scene.product = std::make_shared<const Product>(std::move(product));
    scene.scene.part_materials.resize(1);
    scene.scene.part_materials[0].diffuse = {0.7, 0.3, 0.1};
    scene.scene.lights.emplace_back();
    scene.scene.eye_in_world_mm = {0.0, 10.0, 60.0};
    scene.view = look_at({0.0, 10.0, 60.0}, {0.0, 0.0, 0.0}, 0.4, 64, 48);
    return scene;
}

/// The largest difference as a share of the full floats' value, beyond what the smallest halves are
/// apart.
double worst_share(const ImageF& stored, const ImageF& full) {
    double worst = 0.0;
    for (std::size_t i = 0; i < full.values.size(); ++i) {
        if (i % 4 == 3) continue;
        const auto value = static_cast<double>(full.values[i]);
        const double apart =
            std::abs(static_cast<double>(stored.values[i]) - value) - 3.0 * 0x1p-24;
        if (value > 0.0) worst = worse_of(worst, apart / value);
    }
    return worst;
}

// Each time that a number is stored it moves by 2^-11 of itself at most, by twice that where a
// driver cuts instead of rounding, which OpenGL leaves open.
TEST(HalfFloats, MoveAPictureByTheirRoundingAndNoMore) {
    const HeadlessContext context(GlDevice::automatic);
    const AccuracyScene ball = lit_ball();
    const auto geometry = std::make_shared<const FrameGeometry>(ball.scene.product, ball.view);
    const ImageF full = stored_picture(ball, geometry, StoredHalves::none).working;
    const ImageF inputs = stored_picture(ball, geometry, StoredHalves::inputs).working;
    const ImageF all = stored_picture(ball, geometry, StoredHalves::all).working;
    EXPECT_GT(*std::max_element(full.values.begin(), full.values.end()), 0.1f);
    EXPECT_GT(worst_share(inputs, full), 0.0);
    EXPECT_LT(worst_share(inputs, full), 0x1p-10 * 1.01);
    // Light, shaded fragments, the picture
    EXPECT_GT(worst_share(all, full), worst_share(inputs, full));
    EXPECT_LT(worst_share(all, full), 3.0 * 0x1p-10 * 1.01);
}

TEST(HalfFloats, AreAllThatTheLanesRead) {
    const HeadlessContext context(GlDevice::automatic);
    const AccuracyScene ball = lit_ball();
    const auto geometry = std::make_shared<const FrameGeometry>(ball.scene.product, ball.view);
    EXPECT_THROW(RadianceRenderer(geometry, false, ShadingDevice::processor, StoredHalves::none),
                 std::invalid_argument);
}

constexpr int kSide_px = 32;
constexpr double kDistance_mm = 100.0;

/// A wall that fills the picture, its pixels squares with the middle of the world in a corner of
/// four, and stripes from left to right.
AccuracyScene striped_wall(double stripe_px) {
    AccuracyScene scene;
    Product product;
    add_quad(product.mesh, {-60, -60, 0}, {60, -60, 0}, {60, 60, 0}, {-60, 60, 0});
    product.exchange = part_exchange(product.mesh);
    scene.scene.product = std::make_shared<const Product>(std::move(product));
    scene.scene.part_materials.resize(1);
    scene.scene.part_materials[0].diffuse = {0.6, 0.05, 0.02};
    scene.view = look_at({0.0, 0.0, kDistance_mm}, {0.0, 0.0, 0.0}, 0.4, kSide_px, kSide_px);
    Material white;
    white.diffuse = glm::dvec3(0.85);
    Artwork stripes;
    stripes.size_mm = 2.0 * stripe_px * kDistance_mm / scene.view.focal_px.x;
    scene.scene.artwork.push_back(make_part_artwork(0, stripes, white, nullptr));
    return scene;
}

ArtworkPictures pictures_of(const AccuracyScene& scene) {
    const FrameGeometry geometry(scene.scene.product, scene.view);
    return artwork_pictures(scene.scene, geometry, 256).at(0);
}

TEST(ArtworkFilter, IsExactOnStripesOfWholePixels) {
    const AccuracyScene wall = striped_wall(2.0);
    const FrameGeometry geometry(wall.scene.product, wall.view);
    const double pixel_mm = kDistance_mm / wall.view.focal_px.x;
    EXPECT_NEAR(pixel_across_mm(geometry, 0, {}), pixel_mm, 1e-3 * pixel_mm);
    const ArtworkPictures pictures = pictures_of(wall);
    EXPECT_EQ(colour_differences(pictures.by_footprint, pictures.by_many).size(),
              static_cast<std::size_t>(kSide_px * kSide_px));
    int covered = 0;
    for (int x = 0; x < kSide_px; ++x) {
        // A stripe's middle is the picture's: pixels 15 and 16 are its own
        const bool white = (x + 1 - kSide_px / 2 + 2 * kSide_px) % 4 < 2;
        covered += white ? 1 : 0;
        for (const ImageF* picture :
             {&pictures.by_footprint, &pictures.by_sample, &pictures.by_many}) {
            // Green tells them apart; a hundredth of a pixel is what floats and rays leave of it
            const float expected = white ? 0.85f : pictures.by_sample.at(2, 0, 1);
            EXPECT_NEAR(picture->at(x, 7, 1), expected, 0.01f) << x;
        }
    }
    EXPECT_EQ(covered, kSide_px / 2);
    EXPECT_LT(pictures.by_sample.at(2, 0, 1), 0.3f);
}

TEST(ArtworkFilter, FindsTheMeanOfStripesThatOneSampleMisses) {
    const ArtworkPictures pictures = pictures_of(striped_wall(0.3));
    const auto filtered = colour_differences(pictures.by_footprint, pictures.by_many);
    const auto sampled = colour_differences(pictures.by_sample, pictures.by_many);
    // 256 rays find an edge's share to a hundredth or so, which is less than 1 between these paints
    EXPECT_LT(*std::max_element(filtered.begin(), filtered.end()), 1.0f);
    EXPECT_GT(median(sampled), 10.0f);
}

TEST(ArtworkFilter, IsNotComparedWhereNothingWearsIt) {
    AccuracyScene wall = striped_wall(2.0);
    wall.scene.artwork[0].artwork.place.direction = {0.0, 0.0, 1.0};
    wall.scene.artwork[0].artwork.place.through = false;
    EXPECT_THROW(pictures_of(wall), std::invalid_argument);
}

}  // namespace
}  // namespace livery
