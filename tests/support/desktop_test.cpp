// That the harness sees what is there: a test of the tests' eyes and hands.

#include "support/desktop.h"

#include <atomic>

#include <gtest/gtest.h>

#include "support/screen_watch.h"

namespace livery {
namespace {

TEST(TestDesktop, HasTwoMonitorsAndAMouse) {
    Desktop desktop;
    EXPECT_EQ(desktop.operator_area(), (Rectangle{0, 0, 1280, 800}));
    EXPECT_EQ(desktop.projector_area(), (Rectangle{1280, 0, 1280, 800}));
    desktop.plug_projector(Desktop::Side::left);
    EXPECT_EQ(desktop.projector_area(), (Rectangle{0, 0, 1280, 800}));
    EXPECT_EQ(desktop.operator_area(), (Rectangle{1280, 0, 1280, 800}));
    desktop.unplug_projector();
    EXPECT_FALSE(desktop.projector_plugged());
    EXPECT_THROW(desktop.projector_area(), std::logic_error);
    EXPECT_THROW(desktop.xrandr({"--output", "DUMMY1", "--mode", "1x1"}), std::runtime_error);
}

TEST(TestDesktop, TakesSizesThatTheDriverDoesNotList) {
    Desktop desktop({{3840, 2160}, {1280, 800}, false});
    EXPECT_EQ(desktop.operator_area(), (Rectangle{0, 0, 3840, 2160}));
    EXPECT_EQ(desktop.projector_area().x, 3840);
    EXPECT_THROW(desktop.read({5000, 0, 1000, 10}), std::invalid_argument);
}

TEST(TestDesktop, SeesColoursAndWindows) {
    Desktop desktop({{1280, 800}, {1280, 800}, true});
    const auto set_root = [&](const char* colour) {
        ChildProcess({{"xsetroot", "-solid", colour}, {}, {}, {}}).wait(std::chrono::seconds(10));
    };
    set_root("#102030");
    EXPECT_TRUE(wait_until([&] { return desktop.pixel(1300, 5) == Rgb{16, 32, 48}; }));
    std::atomic<bool> looked{false};
    ScreenWatch watch(desktop, {0, 0, 100, 100}, [&](const Image8& picture) {
        looked = true;
        return colour_at(picture, 50, 50) == Rgb{200, 100, 50};
    });
    ASSERT_TRUE(wait_until([&] { return looked.load(); }));
    set_root("#c86432");
    ASSERT_TRUE(wait_until([&] { return desktop.pixel(50, 50) == Rgb{200, 100, 50}; }));
    const int before = watch.stop().wrong;
    set_root("#000000");
    EXPECT_TRUE(wait_until([&] { return desktop.pixel(50, 50) == Rgb{}; }));
    EXPECT_GE(watch.stop().looks, 1);
    EXPECT_EQ(watch.stop().wrong, before);
}

TEST(TestDesktop, SaysWhatTheServerSaidWhenItDoesNotStart) {
    try {
        Desktop desktop({{40000, 40000}, {40000, 40000}, false});
        FAIL() << "started";
    } catch (const std::runtime_error& error) {
        const std::string message = error.what();
        EXPECT_NE(message.find("xserver-xorg-video-dummy"), std::string::npos) << message;
        EXPECT_NE(message.find("no screens found"), std::string::npos) << message;
    }
}

}  // namespace
}  // namespace livery
