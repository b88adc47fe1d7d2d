#include "scene/colour_calibration.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "core/random.h"

namespace livery {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

ColourCalibration some_calibration() {
    Random random(7);
    ColourCalibration c;
    c.width = 13;
    c.height = 9;
    c.created = "2026-11-21T05:41:04Z";
    c.mode = "robust";
    c.made_with = "a test";
    c.dark_drive = 16.0;
    c.bright_drive = 235.0;
    c.unmixing = ImageF(13, 9, 9);
    c.dark = ImageF(13, 9, 3);
    c.span = ImageF(13, 9, 3);
    c.camera_px = ImageF(13, 9, 2, kNan);
    c.status = Image8(13, 9, 1, static_cast<std::uint8_t>(PixelStatus::measured));
    for (auto* plane : {&c.unmixing, &c.dark, &c.span}) {
        for (float& value : plane->values) value = static_cast<float>(random.normal());
    }
    for (int k = 0; k < 100; ++k)
        c.camera_px.values[static_cast<std::size_t>(k)] = 0.1f * static_cast<float>(k);
    c.status.at(3, 3) = static_cast<std::uint8_t>(PixelStatus::saturated);
    c.unmixing.at(3, 3, 4) = kNan;
    for (auto& curve : c.response) {
        for (int k = 0; k < 33; ++k)
            curve.drive_from_n.push_back(255.0f * std::pow(static_cast<float>(k) / 32.0f, 0.45f));
        curve.largest_violation = 0.0123;
    }
    c.table.grid = 2;
    for (int k = 0; k < 8; ++k)
        c.table.n_from_drive.emplace_back(random.uniform(), random.uniform(), random.uniform());
    c.xyz_from_camera = glm::dmat3(0.4, 0.2, 0.1, 0.3, 0.7, 0.1, 0.2, 0.1, 0.9);
    c.xyz_origin = "primaries";
    c.camera_ambient = {0.1, 0.2, 1.0 / 3.0};
    c.additivity_error = 0.01;
    c.condition_p99 = 3.3;
    c.valid_fraction = 0.9;
    c.ambient_fraction = 0.02;
    c.mixing_spread = 1.1;
    c.warnings = {"one", "two"};
    seal(c);
    return c;
}

TEST(ColourCalibration, ComesBackBitForBit) {
    const auto c = some_calibration();
    const auto folder = std::filesystem::path(testing::TempDir()) / "calibration_round_trip";
    write_calibration(folder, c);
    const auto back = read_calibration(folder);  // which compares the id with the content
    EXPECT_EQ(back.id, c.id);
    EXPECT_EQ(back.dark.values, c.dark.values);
    EXPECT_EQ(back.status.values, c.status.values);
    EXPECT_TRUE(std::isnan(back.camera_px.values.back()));
}

}  // namespace
}  // namespace livery
