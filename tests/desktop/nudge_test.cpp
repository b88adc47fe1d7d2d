// The mock-up moved by hand: with the keys, on the projector, until its lines lie on it.

#include <filesystem>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/paths.h"
#include "desktop/two_monitors.h"
#include "jobs/calibrate/calibration_folder.h"
#include "scene/library.h"
#include "scene/mockup_mask.h"
#include "scene/mockup_pose.h"
#include "session/session.h"

namespace livery {
namespace {

namespace fs = std::filesystem;

class NudgeWindow : public TwoMonitors {
  protected:
    /// A session whose calibration says that the mock-up stands off by this.
    void start_off_by(const Nudge& off) {
        auto running = std::make_shared<RunningStudio>();
        running->document = prepare_session(running->session_file());
        fs::remove(user_folder() / "desktop.json");
        const fs::path prepared = running->document.calibration,
                       folder = running->folder / "off its place";
        fs::copy(prepared, folder, fs::copy_options::recursive);
        right_ = read_camera_file(folder / "projector.json");
        wrong_ = nudged(right_, bounds_of(product_->mesh), off);
        write_camera_file(folder / "projector.json", wrong_);
        running->document.calibration = folder.string();
        {
            Session session = Session::open(running->session_file());
            session.execute(SetCalibration{folder.string()});
        }
        running->desktop = std::make_unique<Desktop>(small_projector());
        use(running);
        start_program();
        pick_projector();
    }
    Image8 lines_of(const View& view) { return wireframe_picture(product_->mesh, view); }

    std::shared_ptr<const Product> product_ = find_product("car");
    View right_, wrong_;
};

TEST_F(NudgeWindow, NightlyPutsAMockUpRightByTheArrowKeys) {
    start_off_by({.right_px = 4.0, .down_px = -2.0, .yaw_px = 3.0});
    const std::string before = program->state("calibration");
    const Image8 look = drive_of_place(0);
    ASSERT_TRUE(projector_shows(look));
    program->click("menu:Projector");
    program->click("menu:nudge");
    program->move_away();
    ASSERT_TRUE(projector_shows(lines_of(wrong_)));
    EXPECT_EQ(program->state("projector_says"), "showing the mock-up's lines");
    EXPECT_EQ(program->state("nudge"), "not moved");

    for (int k = 0; k < 4; ++k) program->press_key("Left");
    for (int k = 0; k < 2; ++k) program->press_key("Down");
    for (int k = 0; k < 3; ++k) program->press_key("ctrl+Left");
    EXPECT_TRUE(projector_shows(lines_of(right_)));
    // One too many, and back.
    program->press_key("shift+Right");
    EXPECT_TRUE(
        projector_shows(lines_of(nudged(right_, bounds_of(product_->mesh), {.right_px = 10.0}))));
    program->press_key("ctrl+z");
    EXPECT_TRUE(projector_shows(lines_of(right_)));

    // Leaving shows the look again and forgets nothing.
    program->press_key("Escape");
    EXPECT_EQ(program->state("nudge"), "closed");
    EXPECT_TRUE(projector_shows(look));
    program->click("tab:Calibrate");
    program->click("open-nudge");
    program->click("nudge:undo");
    program->click("nudge:redo");
    program->move_away();
    EXPECT_TRUE(projector_shows(lines_of(right_)));

    program->click("nudge:keep");
    program->wait_for_state("nudge", "closed");
    const std::string after = program->state("calibration");
    ASSERT_NE(after, before);
    const auto kept = projector_view_of(after);
    ASSERT_TRUE(kept);
    const MockupMotion rest = motion_between(right_, *kept, bounds_of(product_->mesh));
    EXPECT_LT(glm::length(rest.moved_mm), 1e-6);
    EXPECT_LT(rest.turned_deg, 1e-6);
    document.calibration = after;
    EXPECT_TRUE(projector_shows(drive_of_place(0)));

    program->press_key("ctrl+z");
    program->wait_for_state("calibration", before);
    EXPECT_TRUE(projector_shows(look));
}

TEST_F(NudgeWindow, NightlyIsShownOnTheSimulatedMockUpAndKeepsItsKeysToItself) {
    use_shared();
    program->click("tab:Calibrate");
    program->click("open-nudge");
    program->click("view:photograph");
    program->wait_for_state("nudge_drawn", true);
    const auto photographed = program->state("photograph_number");
    const auto shown_look = program->state("shown_look");
    program->press_key("Right");
    program->click("nudge:step-10");
    program->click("nudge:turn-left");
    program->wait_for_state("nudge_drawn", true);
    EXPECT_EQ(program->state("shown_look"), shown_look)
        << "the arrows step through looks otherwise";
    EXPECT_NE(program->state("nudge"), "not moved");
    EXPECT_FALSE(photographed.is_null());
    program->click("nudge:start-over");
    EXPECT_EQ(program->state("nudge"), "not moved");
    program->click("nudge:close");
    program->click("view:preview");
}

}  // namespace
}  // namespace livery
