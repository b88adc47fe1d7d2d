// The projector's monitor: picked by its number, pulled out, put back, moved; and never a trace of
// its picture on the operator's screen.

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <set>
#include <vector>

#include <gtest/gtest.h>

#include "desktop/two_monitors.h"
#include "support/screen_watch.h"

namespace livery {
namespace {

/// Short runs of pixels by which a picture gives itself away wherever it is.
class Signature {
  public:
    explicit Signature(const Image8& picture) {
        constexpr int length = 20, rows = 9;
        for (int i = 1; i < rows; ++i) {
            const int y = picture.height * i / rows;
            for (int x = 0; x + length < picture.width; x += length) {
                std::set<std::array<std::uint8_t, 3>> colours;
                for (int j = 0; j < length; ++j) {
                    const auto* pixel = picture.pixel(x + j, y);
                    colours.insert({pixel[0], pixel[1], pixel[2]});
                }
                if (colours.size() < length / 2) continue;
                const auto* start = picture.pixel(x, y);
                runs_.emplace_back(start, start + 3 * length);
            }
        }
    }

    std::size_t size() const { return runs_.size(); }

    bool is_in(const Image8& screen) const {
        const auto holds = [&](const std::vector<std::uint8_t>& run) {
            return ::memmem(screen.values.data(), screen.values.size(), run.data(), run.size());
        };
        return std::ranges::any_of(runs_, holds);
    }

  private:
    std::vector<std::vector<std::uint8_t>> runs_;
};

class Projector : public TwoMonitors {
  protected:
    /// The studio's window is all on the operator's monitor.
    bool window_is_on_operators_monitor();
    bool operators_monitor_is_free_of_the_projectors_window();
};

bool overlap(const Rectangle& a, const Rectangle& b) {
    return a.x < b.x + b.width && b.x < a.x + a.width && a.y < b.y + b.height &&
           b.y < a.y + a.height;
}

bool Projector::window_is_on_operators_monitor() {
    const Rectangle stage = program->item("stage"), monitor = desktop->operator_area();
    return stage.x >= monitor.x && stage.x + stage.width <= monitor.x + monitor.width &&
           stage.y >= monitor.y && stage.y + stage.height <= monitor.y + monitor.height;
}

bool Projector::operators_monitor_is_free_of_the_projectors_window() {
    return std::ranges::none_of(desktop->windows(), [&](const Desktop::TopWindow& window) {
        return window.title == "Livery projector" && overlap(window.area, desktop->operator_area());
    });
}

TEST_F(Projector, IsPickedByItsNumberAndRemembered) {
    start();
    const Image8 operator_before = desktop->read(desktop->operator_area());
    EXPECT_TRUE(projector_is_black());
    // Large numbers on every monitor, for a moment.
    program->click("show-numbers");
    EXPECT_TRUE(wait_until([&] {
        const Image8 seen = projector_picture();
        return fraction_different(seen, Image8(seen.width, seen.height, 3), 40) > 0.005;
    }));
    program->move_away();
    EXPECT_TRUE(projector_is_black());
    sleep_ms(500);  // the numbers' windows give the focus back
    pick_projector();
    EXPECT_TRUE(projector_shows(drive_of_place(0))) << program->words();
    EXPECT_TRUE(window_is_on_operators_monitor());
    EXPECT_FALSE(Signature(projector_picture()).is_in(desktop->read(desktop->operator_area())));

    EXPECT_EQ(program->quit(), 0);
    EXPECT_TRUE(projector_is_black());
    start_program();
    EXPECT_TRUE(projector_shows(drive_of_place(0)));
}

TEST_F(Projector, UnpluggedItIsNowhereAndPluggedInItIsBack) {
    use_shared();
    const Image8 blue = drive_with_body("solid blue"), red = drive_with_body("solid red");
    program->click("part:body");
    program->click("paint:solid blue");
    program->move_away();
    ASSERT_TRUE(projector_shows(blue));
    const Signature signature(blue);
    ASSERT_GT(signature.size(), 20u);
    ASSERT_TRUE(signature.is_in(projector_picture()));

    ScreenWatch watch(*desktop, desktop->operator_area(), [&](const Image8& screen) {
        return signature.is_in(screen);
    });
    for (int times = 0; times < 3; ++times) {
        desktop->unplug_projector();
        for (int i = 0; i < 40; ++i) {
            EXPECT_TRUE(operators_monitor_is_free_of_the_projectors_window());
            sleep_ms(10);
        }
        EXPECT_TRUE(program->process().running());
        desktop->plug_projector();
        EXPECT_TRUE(projector_shows(blue));
    }
    // What is changed meanwhile is there when it is back.
    desktop->unplug_projector();
    program->click("paint:solid red");
    program->move_away();
    EXPECT_TRUE(operator_sees("red"));
    desktop->plug_projector();
    EXPECT_TRUE(projector_shows(red));
    // Black stays black.
    desktop->press_key("b");
    EXPECT_TRUE(projector_is_black());
    desktop->unplug_projector();
    sleep_ms(200);
    desktop->plug_projector();
    EXPECT_TRUE(projector_is_black());
    desktop->press_key("b");
    EXPECT_TRUE(projector_shows(red));

    const auto seen = watch.stop();
    EXPECT_GT(seen.looks, 10);
    EXPECT_EQ(seen.wrong, 0) << "the projector's picture was on the operator's screen: "
                             << (seen.wrong ? saved(seen.first_wrong, "leak") : "");
}

// As large as the operator's: a smaller one would leave part of the operator's window where it is.
TEST_F(Projector, NightlyFollowsItsMonitorToAnotherPlace) {
    start({.projector_px = kFullProjector_px});
    pick_projector();
    const Image8 a = drive_of_place(0);
    for (const auto side : {Desktop::Side::left, Desktop::Side::below, Desktop::Side::right}) {
        desktop->plug_projector(side);
        EXPECT_TRUE(projector_shows(a));
        EXPECT_TRUE(wait_until([&] { return window_is_on_operators_monitor(); }))
            << program->state("projector") << ::testing::PrintToString(static_cast<int>(side));
        EXPECT_TRUE(operators_monitor_is_free_of_the_projectors_window());
    }
}

}  // namespace
}  // namespace livery
