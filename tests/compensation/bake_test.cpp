// What a calibration must be before it is baked, and the white that its projector can show.
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

#include "compensation/compensate.h"
#include "compensation/compensation.h"
#include "compensation/synthetic.h"
#include "core/error.h"
#include "support/message_of.h"

namespace livery {
namespace {

using synthetic::calibrate;
using synthetic::kInf;
using synthetic::kNan;
using synthetic::make_world;
using synthetic::World;

TEST(Bake, NamesWhatIsWrongWithACalibration) {
    const World world = make_world(6, 4, 61);
    const ColourCalibration good = calibrate(world);
    const auto broken = [&](auto&& change) {
        ColourCalibration c = good;
        change(c);
        return message_of([&] { bake(c, 0.3); });
    };
    EXPECT_EQ(message_of([&] { bake(good, 0.3); }), "nothing thrown");
    EXPECT_EQ(broken([](auto& c) { c.unmixing = ImageF(6, 4, 3); }),
              "calibration plane unmixing is 6x4 with 3 channels, expected 6x4 with 9 channels");
    EXPECT_NE(broken([](auto& c) { c.dark = ImageF(5, 4, 3); }).find("plane dark is 5x4"),
              std::string::npos);
    EXPECT_NE(broken([](auto& c) { c.span = ImageF(); }).find("plane span is 0x0"),
              std::string::npos);
    EXPECT_NE(broken([](auto& c) { c.status = Image8(6, 5, 1); }).find("plane status is 6x5"),
              std::string::npos);
    EXPECT_NE(broken([](auto& c) { c.span.at(2, 1, 1) = 0.0f; }).find("pixel (2, 1) is marked"),
              std::string::npos);
    EXPECT_NE(broken([](auto& c) { c.dark.at(3, 2, 0) = kNan; }).find("pixel (3, 2) is marked"),
              std::string::npos);
    EXPECT_NE(broken([](auto& c) { c.unmixing.at(1, 3, 4) = kInf; }).find("pixel (1, 3)"),
              std::string::npos);
    EXPECT_NE(broken([](auto& c) { c.xyz_from_camera = glm::dmat3(0.0); }).find("determinant"),
              std::string::npos);
    EXPECT_EQ(broken([](auto& c) { c.response[1].drive_from_n.clear(); }),
              "response of channel 1 has 0 samples, expected 2 or more");
    EXPECT_NE(broken([](auto& c) {
                  c.response[2].drive_from_n[7] = 200.0f;
              }).find("response of channel 2"),
              std::string::npos);
    EXPECT_NE(broken([](auto& c) {
                  c.response[0].drive_from_n[3] = kNan;
              }).find("response of channel 0 is nan"),
              std::string::npos);
    EXPECT_NE(broken([](auto& c) { c.table.grid = 9; }).find("drive table of 9 nodes"),
              std::string::npos);
    EXPECT_NE(broken([](auto& c) { c.width = 0; }).find("0x4 pixels"), std::string::npos);
    for (const double white : {0.0, -1.0, static_cast<double>(kNan), static_cast<double>(kInf)}) {
        EXPECT_NE(message_of([&] { bake(good, white); }).find("design white of"),
                  std::string::npos);
    }
    // The same numbers in an invalid pixel harm nobody.
    EXPECT_EQ(broken([](auto& c) {
                  c.span.at(2, 1, 1) = kNan;
                  c.status.at(2, 1) = static_cast<std::uint8_t>(PixelStatus::too_dark);
              }),
              "nothing thrown");
}

// White made by equal primaries whose XYZ adds up to D65: the brightest neutral of a pixel with
// brightness s is s (1 + leak) + ambient in every channel, in closed form.
World neutral_world(int width, int height) {
    World world;
    world.width = width;
    world.height = height;
    const glm::dvec3 unit = glm::inverse(xyz_from_working()) * d65_xyz();
    world.xyz_from_camera = xyz_from_working();
    glm::dmat3 mixing(0.9, 0.08, 0.02, 0.07, 0.85, 0.08, 0.03, 0.07, 0.9);
    for (int i = 0; i < width * height; ++i) {
        world.mixing.push_back(mixing * (static_cast<double>(i + 1) / (width * height)));
        world.ambient.push_back(glm::dvec3(0.0));
        world.lit.push_back(true);
    }
    EXPECT_NEAR(unit.x, 1.0, 1e-9);
    return world;
}

TEST(DesignWhite, IsThePercentileOfWhatEachPixelCanShow) {
    const World world = neutral_world(20, 10);  // brightest neutrals 1/200 ... 200/200
    const ColourCalibration calibration = calibrate(world);
    for (const double percentile : {0.0, 5.0, 20.0, 50.0, 99.0, 100.0}) {
        const double white = design_white_luminance(calibration, percentile, {});
        int can = 0;
        for (int i = 1; i <= 200; ++i) can += i / 200.0 >= white * (1.0 - 1e-5) ? 1 : 0;
        const int must = static_cast<int>(std::ceil((100.0 - percentile) / 100.0 * 200.0));
        EXPECT_GE(can, must) << percentile;
        EXPECT_LE(can, std::max(must, 1)) << percentile;  // and no dimmer than need be
        const int rank = std::min(static_cast<int>(percentile * 2.0), 199);
        EXPECT_NEAR(white, (rank + 1) / 200.0, 1e-5);
    }
}

TEST(DesignWhite, IsReachedByFullDriveAtThePixelThatSetsIt) {
    const World world = neutral_world(20, 10);
    const ColourCalibration calibration = calibrate(world);
    const double white = design_white_luminance(calibration, 20.0, {});
    CompensationStats stats;
    const Image8 out = compensate(bake(calibration, white), ImageF(20, 10, 3, 1.0f), &stats);
    for (int k = 0; k < 3; ++k) {
        EXPECT_EQ(out.values[3 * 40 + static_cast<std::size_t>(k)], 255);
        EXPECT_LT(out.values[3 * 41 + static_cast<std::size_t>(k)], 255);
    }
    EXPECT_NEAR(stats.clipped_high_fraction, 0.2, 1e-9);
}

TEST(DesignWhite, CountsOnlyTheMockup) {
    const ColourCalibration calibration = calibrate(neutral_world(20, 10));
    Image8 mask(20, 10, 1);
    for (std::size_t i = 100; i < 200; ++i) mask.values[i] = 1;
    EXPECT_NEAR(design_white_luminance(calibration, 0.0, mask), 101.0 / 200.0, 1e-5);
    EXPECT_NE(message_of([&] {
                  design_white_luminance(calibration, 20.0, Image8(10, 10, 1));
              }).find("plane mock-up mask is 10x10"),
              std::string::npos);
    EXPECT_THROW(design_white_luminance(calibration, 20.0, Image8(20, 10, 1)), Refused);
    for (const double percentile : {-1.0, 100.5, static_cast<double>(kNan)}) {
        EXPECT_THROW(design_white_luminance(calibration, percentile, {}), std::invalid_argument);
    }
}

// A surface that swallows blue: the weakest channel alone decides how bright white can be.
TEST(DesignWhite, IsLimitedByTheWeakestChannel) {
    World world = neutral_world(4, 4);
    for (std::size_t i = 0; i < 16; ++i) {
        world.mixing[i] = glm::dmat3(1.0);
        world.mixing[i][2][2] = 0.25;
    }
    const ColourCalibration calibration = calibrate(world);
    EXPECT_NEAR(design_white_luminance(calibration, 20.0, {}), 0.25, 1e-6);
    // Ambient light adds to what can be shown.
    for (glm::dvec3& ambient : world.ambient) ambient = glm::dvec3(0.01);
    EXPECT_NEAR(design_white_luminance(calibrate(world), 20.0, {}), 0.26, 1e-6);
}

}  // namespace
}  // namespace livery
