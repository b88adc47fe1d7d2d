// A calibration that an older Livery wrote. Its id is a hash of all that is in it: a value that
// were read otherwise would be refused.

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "scene/colour_calibration.h"
#include "scene/view.h"
#include "support/old_files.h"
#include "support/temporary_folder.h"

namespace livery {
namespace {

TEST(OldCalibration, OpensWithItsIdItsResidualsAndItsMasks) {
    const TemporaryFolder folder;
    const auto old = testing::unpacked_old_files(folder) / "calibration";
    const ColourCalibration c = read_calibration(old);
    EXPECT_EQ(c.id, testing::kOldCalibrationId);
    EXPECT_EQ(c.created, "2026-11-27T21:57:50Z");
    EXPECT_EQ(c.mode, "robust");
    EXPECT_EQ(c.made_with, "camera of bench small, its own projector");
    EXPECT_EQ(c.width, 64);
    EXPECT_EQ(c.height, 40);
    EXPECT_EQ(c.additivity_error, 0.00014990035621302396);
    EXPECT_EQ(c.condition_p99, 1.8234869241714478);
    EXPECT_EQ(c.valid_fraction, 0.8997005988023953);
    EXPECT_EQ(c.ambient_fraction, 0.0);
    EXPECT_EQ(c.mixing_spread, 0.7352977816535365);
    EXPECT_EQ(c.predicted_fraction, 0.01394585726004922);
    EXPECT_EQ(c.prediction_error_median, 0.00776354456320405);
    EXPECT_EQ(c.prediction_error_p95, 0.2830158472061157);
    EXPECT_EQ(c.warnings, std::vector<std::string>{});
    EXPECT_EQ(c.table.grid, 0);
    EXPECT_EQ(c.xyz_origin, "primaries");
    EXPECT_EQ(c.xyz_from_camera[1][1], 6.218584303677359e-06);
    for (const auto& curve : c.response) EXPECT_EQ(curve.drive_from_n.size(), 2048u);
    EXPECT_EQ(c.response[0].drive_from_n[1024], 177.54615783691406f);
    EXPECT_EQ(c.span.at(30, 20, 1), 66212.859375f);
    EXPECT_EQ(c.camera_px.at(30, 20, 0), 66.217323303f);
    std::array<int, 10> pixels{};
    for (const std::uint8_t status : c.status.values) ++pixels.at(status);
    EXPECT_EQ(pixels, (std::array<int, 10>{1224, 1192, 17, 0, 0, 0, 0, 117, 0, 10}));
    // Where it was made, its projector
    const View projector = read_camera_file(old / "projector.json");
    EXPECT_EQ(projector.width, 64);
    EXPECT_EQ(projector.focal_px.x, 176.5);

    write_calibration(folder / "again", c);
    EXPECT_EQ(read_calibration(folder / "again").id, c.id);
}

}  // namespace
}  // namespace livery
