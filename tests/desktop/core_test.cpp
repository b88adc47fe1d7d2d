// The desktop program on two monitors, as a designer uses it: every action is checked by the pixels
// of both screens, before and after.

#include <atomic>

#include <gtest/gtest.h>

#include "core/image_io.h"
#include "desktop/two_monitors.h"
#include "support/screen_watch.h"

namespace livery {
namespace {

using namespace std::chrono_literals;

/// Swap paints by mouse and keyboard, hover, Esc, undo: what must work everywhere.
class Core : public TwoMonitors {
  protected:
    void swap_hover_and_undo();
};

void Core::swap_hover_and_undo() {
    const Image8 first = drive_of_place(0);
    const Image8 red = drive_with_body("solid red"), blue = drive_with_body("solid blue"),
                 green = drive_with_body("solid green");
    ASSERT_TRUE(projector_shows(first));
    program->click("part:body");

    // By mouse: what is pointed at shows, and leaving takes it back.
    program->hover("paint:solid blue");
    EXPECT_TRUE(projector_shows(blue));
    EXPECT_TRUE(operator_sees("blue"));
    program->move_away();
    EXPECT_TRUE(projector_shows(first));

    // Esc takes it back under the pointer.
    program->hover("paint:solid blue");
    EXPECT_TRUE(projector_shows(blue));
    desktop->press_key("Escape");
    EXPECT_TRUE(projector_shows(first));
    program->move_away();

    program->click("paint:solid green");
    program->move_away();
    EXPECT_TRUE(projector_shows(green));
    EXPECT_TRUE(operator_sees("green"));
    program->click("paint:solid blue");
    program->move_away();
    EXPECT_TRUE(projector_shows(blue));
    EXPECT_TRUE(operator_sees("blue"));

    // By keyboard.
    desktop->press_key("ctrl+z");
    EXPECT_TRUE(projector_shows(green));
    EXPECT_TRUE(operator_sees("green"));
    desktop->press_key("ctrl+y");
    EXPECT_TRUE(projector_shows(blue));
    EXPECT_TRUE(operator_sees("blue"));
    program->click("paint-search");
    desktop->type("solid red");
    desktop->press_key("Down");
    EXPECT_TRUE(projector_shows(red));
    desktop->press_key("Return");
    EXPECT_TRUE(projector_shows(red));
    EXPECT_TRUE(operator_sees("red"));
}

TEST_F(Core, SwapsPaintsOnTwoMonitors) {
    use_shared();
    swap_hover_and_undo();
}

// As most people have it, every pixel of a common projector too.
TEST_F(Core, NightlyDoesTheSameInFullSizeUnderAWindowManager) {
    DesktopOptions options;
    options.window_manager = true;
    options.projector_px = kFullProjector_px;
    start(options);
    pick_projector();
    swap_hover_and_undo();
    desktop->unplug_projector();
    EXPECT_TRUE(operator_sees("red"));
    desktop->plug_projector();
    EXPECT_TRUE(projector_shows(drive_with_body("solid red")));
    EXPECT_EQ(program->quit(), 0);
}

// As on a graphics card, in software: nothing of the mock-up's picture passes the processor until
// it is saved.
TEST_F(Core, NightlySwapsPaintsInOpenGl) {
    start(small_projector(), {"--shading", "opengl"});
    pick_projector();
    ASSERT_TRUE(projector_shows(drive_of_place(0)));
    program->click("part:body");
    program->hover("paint:solid blue");
    EXPECT_TRUE(projector_shows(drive_with_body("solid blue")));
    program->click("paint:solid green");
    program->move_away();
    EXPECT_TRUE(projector_shows(drive_with_body("solid green")));
    // Light between parts of another paint comes a moment later.
    program->wait_for_state("unfinished", "");
    ASSERT_TRUE(wait_until([&] {
        return program->state("shown_number") == program->state("asked_number") &&
               program->state("unfinished") == "";
    }));
    const Image8 shown = projector_picture();
    const std::filesystem::path file = studio->folder / "sent.png";
    desktop->press_key("ctrl+s");
    program->click("save-picture:what-3");
    program->click("file-dialog:path");
    desktop->press_key("ctrl+a");
    desktop->type(file.string());
    program->click("file-dialog:ok");
    EXPECT_TRUE(wait_until([&] { return std::filesystem::exists(file); }));
    const Image8 shown_after = projector_picture();
    EXPECT_EQ(program->quit(), 0);
    // Of the pictures before and after, if another one was finished while the dialog was filled in
    const Image8 kept = read_png(file);
    EXPECT_TRUE(kept.values == shown.values || kept.values == shown_after.values)
        << "before: " << saved(shown, "before") << ", after: " << saved(shown_after, "after")
        << ", kept: " << saved(kept, "kept");
}

}  // namespace
}  // namespace livery
