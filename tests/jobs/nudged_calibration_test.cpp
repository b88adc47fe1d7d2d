#include <filesystem>
#include <stdexcept>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "jobs/calibrate/calibration_folder.h"
#include "jobs/calibrate/reposed_calibration.h"
#include "jobs/synthetic_calibration.h"
#include "scene/mockup_pose.h"
#include "support/file_error.h"
#include "support/temporary_folder.h"

namespace livery {
namespace {

const Bounds kMockup{{-90, 0, -40}, {90, 60, 40}};

class NudgedCalibration : public ::testing::Test {
  protected:
    NudgedCalibration() {
        seal(calibration_);
        write_setup(from_, calibration_, projector_);
        CalibrationOrigin origin;
        origin.product = "car";
        origin.room.emplace();
        origin.room->projector = projector_;
        origin.room->camera = look_at({-250, 200, 700}, {0, 30, 0}, 0.4, 64, 40);
        origin.ends.emplace();
        origin.ends->white = ImageF(64, 40, 1, 0.5f);
        origin.ends->black = ImageF(64, 40, 1, 0.1f);
        origin.ends->exposure_s = 0.1;
        write_origin(from_, origin);
    }

    TemporaryFolder folder_;
    std::filesystem::path from_ = folder_ / "from", to_ = folder_ / "to";
    View projector_ = look_at({300, 400, 900}, {20, 10, 0}, 0.4, 32, 20);
    ColourCalibration calibration_ = synthetic_calibration(ImageF(32, 20, 1, 1.0f));
};

TEST_F(NudgedCalibration, IsAVersionWithItsColoursAndAnotherPose) {
    const View moved = nudged(projector_, kMockup, {.right_px = 0.5, .yaw_px = 0.2});
    const std::string id = write_nudged(from_, to_, moved, kMockup);
    EXPECT_EQ(projector_view_of(to_), moved);
    const ColourCalibration written = read_calibration(to_);
    EXPECT_EQ(written.id, id);
    EXPECT_NE(written.id, calibration_.id);
    EXPECT_EQ(written.unmixing.values, calibration_.unmixing.values);
    EXPECT_EQ(written.status.values, calibration_.status.values);
    EXPECT_NE(written.made_with.find("0.50 px to the right"), std::string::npos)
        << written.made_with;
    EXPECT_EQ(projector_view_of(from_), projector_) << "the one before stays as it is";
    EXPECT_EQ(read_calibration(from_).id, calibration_.id);

    const auto before = read_origin(from_), after = read_origin(to_);
    ASSERT_TRUE(after && after->room && after->ends);
    EXPECT_EQ(after->room->projector, moved);
    EXPECT_EQ(after->ends->white.values, before->ends->white.values);
    ASSERT_EQ(after->room->warnings.size(), 1u);
    // Camera and projector stay together: the mock-up was moved before both.
    const auto between = [](const RoomGeometry& room) {
        return room.camera.view_from_world * inverse(room.projector.view_from_world);
    };
    const Rigid3 then = between(*before->room), now = between(*after->room);
    EXPECT_LT(glm::distance(then.translation, now.translation), 1e-9);
    for (int k = 0; k < 3; ++k) EXPECT_LT(glm::distance(then.rotation[k], now.rotation[k]), 1e-12);
}

TEST_F(NudgedCalibration, NeedsNoOrigin) {
    std::filesystem::remove(from_ / "origin.json");
    write_nudged(from_, to_, nudged(projector_, kMockup, {.down_px = 1.0}), kMockup);
    EXPECT_FALSE(read_origin(to_));
}

TEST_F(NudgedCalibration, MovesNoLensAndNothingUnknown) {
    View zoomed = projector_;
    zoomed.focal_px *= 1.01;
    EXPECT_THROW(write_nudged(from_, to_, zoomed, kMockup), std::invalid_argument);
    std::filesystem::remove(from_ / "projector.json");
    EXPECT_THROW(write_nudged(from_, to_, projector_, kMockup), FileError);
    EXPECT_FALSE(std::filesystem::exists(to_));
}

}  // namespace
}  // namespace livery
