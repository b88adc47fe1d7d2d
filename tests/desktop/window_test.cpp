// The operator's window among other windows, by its keys alone, and in its least size.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "desktop/two_monitors.h"
#include "studio/window/window_place.h"
#include "support/run_program.h"

namespace livery {
namespace {

using namespace std::chrono_literals;

class OperatorsWindow : public TwoMonitors {
  protected:
    /// Whether anything but the bare desktop is there.
    bool is_seen() {
        const Image8 screen = desktop->read(desktop->operator_area());
        return std::any_of(
            screen.values.begin(), screen.values.end(), [](auto value) { return value > 60; });
    }
    ProgramRun start_again() {
        return run_program(LIVERY_PROGRAM,
                           {"desktop", "--session", studio->session_file().string()});
    }
};

TEST_F(OperatorsWindow, ComesBackWhenTheProgramIsStartedAgain) {
    DesktopOptions options = small_projector();
    options.window_manager = true;
    start(options);
    ASSERT_TRUE(wait_until([&] { return is_seen(); }));
    desktop->minimise_active_window();
    ASSERT_TRUE(wait_until([&] { return !is_seen(); }));
    const ProgramRun second = start_again();
    EXPECT_EQ(second.exit_code, 0) << second.err;
    EXPECT_TRUE(wait_until([&] { return is_seen(); }));
    // It has the keyboard, too.
    desktop->press_key("F6");
    program->wait_for_state("view", "eye");
    EXPECT_EQ(program->quit(), 0);
}

TEST_F(OperatorsWindow, NoButtonsOverlapInItsLeastSize) {
    start();
    studio->program.reset();
    StudioStart how;
    how.session = studio->session_file();
    how.size_px = kLeastSize_px;
    studio->program = std::make_unique<StudioProgram>(*desktop, how);
    program = studio->program.get();
    pick_projector();
    for (const char* tab : {"Paints", "Paint", "Artwork", "Light", "Calibrate", "Frame"}) {
        program->click(std::string("tab:") + tab);
        program->move_away();
        sleep_ms(300);
        // Regions hold others, and a colour's row is also an item as a whole.
        std::vector<std::pair<std::string, Rectangle>> buttons;
        for (const auto& [name, place] : program->items()) {
            const bool is_region = name == "stage" || name == "swatches" || name == "wipe-line" ||
                                   name.starts_with("param:") || name.starts_with("light-pad") ||
                                   name.ends_with("colour");
            if (!is_region) buttons.emplace_back(name, place);
        }
        for (std::size_t i = 0; i < buttons.size(); ++i) {
            for (std::size_t j = i + 1; j < buttons.size(); ++j) {
                const Rectangle &a = buttons[i].second, &b = buttons[j].second;
                const int across = std::min(a.x + a.width, b.x + b.width) - std::max(a.x, b.x);
                const int down = std::min(a.y + a.height, b.y + b.height) - std::max(a.y, b.y);
                // Neighbours in a list touch by a pixel that both were rounded to.
                EXPECT_FALSE(across > 1 && down > 1)
                    << tab << ": " << buttons[i].first << " and " << buttons[j].first;
            }
        }
    }
    EXPECT_EQ(program->quit(), 0);
}

TEST_F(OperatorsWindow, TakesLargerAndSmallerText) {
    start();
    studio->program.reset();
    StudioStart how;
    how.session = studio->session_file();
    how.ui_scale.reset();
    studio->program = std::make_unique<StudioProgram>(*desktop, how);
    program = studio->program.get();
    pick_projector();
    const double usual = program->state("scale");
    const auto becomes = [&](double scale) {
        return wait_until(
            [&] { return std::abs(program->state("scale").get<double>() - scale) < 0.01; });
    };
    const int height_px = program->item("part:body").height;
    for (const double larger : {1.1, 1.21}) {
        program->press_key("ctrl+equal");
        EXPECT_TRUE(becomes(usual * larger));
    }
    EXPECT_GT(program->item("part:body").height, height_px);
    EXPECT_TRUE(projector_shows(drive_of_place(0)));
    program->press_key("ctrl+minus");
    EXPECT_TRUE(becomes(usual * 1.1));
    program->press_key("ctrl+0");
    EXPECT_TRUE(becomes(usual));
    EXPECT_EQ(program->item("part:body").height, height_px);
    EXPECT_EQ(program->quit(), 0);
}

TEST_F(OperatorsWindow, IsWorkedWithTheKeysAlone) {
    use_shared();
    // test_studio goes through every panel by Tab.
    for (int k = 0; k < 200 && program->state("focused") != "part:body"; ++k)
        program->press_key("Tab");
    ASSERT_EQ(program->state("focused"), "part:body");
    program->press_key("Return");
    program->press_key("ctrl+Tab");
    program->wait_for_state("open_tab", 1);
    program->press_key("ctrl+shift+Tab");
    program->wait_for_state("open_tab", 0);
    const auto wears = drive_with_body("solid red");
    program->press_key("ctrl+k");
    program->wait_for_state("focused", "paint-search");
    desktop->type("solid red");
    program->press_key("Return");
    EXPECT_TRUE(projector_shows(wears));
}

}  // namespace
}  // namespace livery
