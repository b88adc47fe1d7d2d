#include <limits>

#include <gtest/gtest.h>

#include "core/colour.h"
#include "core/image_io.h"
#include "jobs/comparison.h"
#include "jobs/render/render.h"
#include "support/temporary_folder.h"

namespace livery {
namespace {

TEST(Picture, WhiteBecomesWhite) {
    ImageF xyz(1, 1, 3);
    for (int c = 0; c < 3; ++c) xyz.at(0, 0, c) = static_cast<float>(7.0 * d65_xyz()[c]);
    const Image8 picture = srgb_from_xyz(xyz, 7.0);
    for (int c = 0; c < 3; ++c) EXPECT_EQ(picture.at(0, 0, c), 255);
    // 0.2140 linear is sRGB 128 within half a level (IEC 61966-2-1).
    const Image8 grey = srgb_from_xyz(xyz, 7.0 / 0.2158605);
    for (int c = 0; c < 3; ++c) EXPECT_EQ(grey.at(0, 0, c), 128);
}

TEST(Picture, CropAndBoundsAgree) {
    Image8 mask(10, 8, 1);
    mask.at(3, 2) = 255;
    mask.at(6, 5) = 255;
    const PixelRectangle box = bounds_of_mask(mask, 1);
    EXPECT_EQ(box.left, 2);
    EXPECT_EQ(box.top, 1);
    EXPECT_EQ(box.right, 8);
    EXPECT_EQ(box.bottom, 7);
    const Image8 part = crop(mask, box);
    EXPECT_EQ(part.width, 6);
    EXPECT_EQ(part.at(1, 1), 255);
    EXPECT_EQ(part.at(4, 4), 255);
    // Nothing set: the whole picture.
    EXPECT_EQ(bounds_of_mask(Image8(5, 4, 1), 1).right, 5);
}

TEST(Picture, DifferenceMapGetsLighterAndGreysWhatIsMissing) {
    const Image8 legend = difference_legend(64, 1);
    double before = -1.0;
    for (int x = 0; x < legend.width; x += 4) {
        glm::dvec3 linear;
        for (int c = 0; c < 3; ++c) linear[c] = srgb_decode(legend.at(x, 0, c) / 255.0);
        const double lightness = oklab_from_xyz(xyz_from_rec709() * linear).x;
        EXPECT_GT(lightness, before) << x;
        before = lightness;
    }
    const ImageF missing(1, 1, 1, std::numeric_limits<float>::quiet_NaN());
    EXPECT_EQ(difference_map(missing, 5.0).at(0, 0, 0), 96);
}

/// A covered pixel, one that the product covers half and one by a sixteenth, of the same colour.
RenderedFrame silhouette() {
    RenderedFrame frame;
    frame.radiance_working = ImageF(4, 1, 4, 0.0f);
    const float coverage[] = {1.0f, 0.5f, 0.0625f, 0.0f};
    for (int x = 0; x < 4; ++x) {
        for (int c = 0; c < 3; ++c) frame.radiance_working.at(x, 0, c) = x < 3 ? 0.64f : 0.0f;
        frame.radiance_working.at(x, 0, 3) = coverage[x];
    }
    return frame;
}

TEST(Picture, ExrIsMultipliedByItsCoverage) {
    const TemporaryFolder folder;
    const auto file = folder.path() / "silhouette.exr";
    write_frame(file, silhouette(), FrameStage::radiance);
    const ImageF stored = read_image(file).image;
    const float expected[] = {0.64f, 0.32f, 0.04f, 0.0f};
    for (int x = 0; x < 4; ++x) {
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(stored.at(x, 0, c), expected[x], 1e-6f) << x;
    }
    EXPECT_EQ(stored.at(1, 0, 3), 0.5f);
    // What a target asks of a pixel is the colour that covers it, as it was before it was written.
    const TargetPicture read = read_target_picture(file, 4, 1);
    EXPECT_TRUE(read.has_coverage);
    const ImageF& wanted = read.wanted;
    for (int x = 0; x < 3; ++x) {
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(wanted.at(x, 0, c), 0.64f, 1e-5f) << x;
    }
    EXPECT_EQ(wanted.at(2, 0, 3), 0.0625f);
    EXPECT_EQ(wanted.at(3, 0, 0), 0.0f);
}

TEST(Picture, PngHasSmoothSilhouettes) {
    const TemporaryFolder folder;
    const auto file = folder.path() / "silhouette.png";
    write_frame(file, silhouette(), FrameStage::radiance);
    const ImageF stored = read_image(file).image;
    const double expected[] = {0.64, 0.32, 0.04, 0.0};
    for (int x = 0; x < 4; ++x) {
        EXPECT_NEAR(stored.at(x, 0, 1), 255.0 * srgb_encode(expected[x]), 0.51) << x;
    }
}

}  // namespace
}  // namespace livery
