// What the desktop says on the session bus, and what is made of it. The X server is Xorg's: the
// watch is told that it is Xwayland.
#include "projection/desktop_watch.h"

#include <atomic>
#include <chrono>

#include <gtest/gtest.h>

#include "fake_desktop_bus.h"
#include "projection/check_signal.h"
#include "stage.h"

namespace livery {
namespace {

using Kind = SignalWarning::Kind;
using Severity = SignalWarning::Severity;

constexpr const char* kMutter = "org.gnome.Mutter.DisplayConfig";

/// The test's desktop as Mutter would have it: its projector at this scale, in so many pixels.
SaidState said_of_desktop(double scale = 1.0, glm::ivec2 projector_px = {1280, 800}) {
    auto said = said_of_two(scale);
    said.monitors[1].modes = {{projector_px.x, projector_px.y}};
    return said;
}

std::string id_of_projector() { return monitor_id("HDMI-1", {"EPS", "EPSON PJ", "X4KF123"}); }

struct DesktopWatchTest : ::testing::Test {
    Desktop& desktop = shared_desktop(false, {1280, 800});
};

TEST_F(DesktopWatchTest, NamesMonitorsAsMutterDoes) {
    FakeDesktopBus bus(kMutter);
    bus.tell_monitors(said_of_desktop());
    DesktopWatch watch(true);
    EXPECT_EQ(watch.state().problem, "");
    const auto list = list_monitors(&watch);
    ASSERT_EQ(list.size(), 2u);
    EXPECT_EQ(list[0].name, "eDP-1, BOE");
    EXPECT_EQ(list[1].name, "HDMI-1, EPSON PJ");
    EXPECT_EQ(list[1].id, id_of_projector());
    EXPECT_EQ(list[1].mode_px, glm::ivec2(1280, 800));
    EXPECT_EQ(list[1].refresh_hz, 60.0);
    EXPECT_EQ(list_monitors()[1].name, "DUMMY1") << "without a watch X alone is asked";
    DesktopWatch on_xorg(false);
    EXPECT_EQ(list_monitors(&on_xorg)[1].name, "DUMMY1");
}

TEST_F(DesktopWatchTest, TellsOfEveryChange) {
    FakeDesktopBus bus(kMutter, "org.gnome.SettingsDaemon.Color");
    bus.tell_monitors(said_of_desktop());
    std::atomic<int> changes{0};
    DesktopWatch watch(true, [&] { ++changes; });
    EXPECT_EQ(watch.state().night_light, NightLight::off);
    EXPECT_EQ(watch.state().night_light_of, "GNOME");
    const auto projector = find_monitor(list_monitors(&watch), id_of_projector());
    ASSERT_TRUE(projector);
    const auto has = [&](Kind kind, Severity severity) {
        const auto list = check_signal(*projector, {0, 0}, watch);
        return std::any_of(list.begin(), list.end(), [&](const SignalWarning& warning) {
            return warning.kind == kind && warning.severity == severity;
        });
    };
    EXPECT_FALSE(has(Kind::scaled, Severity::error));
    // What X shows of the desktop is the same, and the projector has other pixels.
    bus.tell_monitors(said_of_desktop(1.5, {1920, 1200}));
    EXPECT_TRUE(wait_until([&] { return changes == 1; }));
    EXPECT_TRUE(has(Kind::scaled, Severity::error));
    EXPECT_EQ(check_signal(*projector, {0, 0}, watch).front().severity, Severity::error)
        << "the worst comes first";
    bus.tell_monitors(said_of_desktop());
    EXPECT_TRUE(wait_until([&] { return changes == 2; }));
    EXPECT_FALSE(has(Kind::scaled, Severity::error));
    EXPECT_FALSE(has(Kind::night_light, Severity::warning));
    bus.property = true;
    bus.send_signal(
        "/org/gnome/SettingsDaemon/Color", "org.freedesktop.DBus.Properties", "PropertiesChanged");
    EXPECT_TRUE(wait_until([&] { return changes == 3; }));
    EXPECT_TRUE(has(Kind::night_light, Severity::warning));
}

TEST_F(DesktopWatchTest, SaysWhyItKnowsNothing) {
    ::unsetenv("DBUS_SESSION_BUS_ADDRESS");
    ::setenv("XDG_RUNTIME_DIR", "/nonexistent", 1);
    const auto unnamed = [](DesktopWatch& watch) {
        const Monitor monitor = list_monitors(&watch).at(1);
        EXPECT_EQ(monitor.id, "DUMMY1");
        EXPECT_EQ(monitor.mode_px, glm::ivec2(0, 0)) << "X's modes are Xwayland's own";
        EXPECT_FALSE(monitor.wayland);
        const auto list = check_signal(monitor, {0, 0}, watch);
        ASSERT_EQ(list.size(), 2u);
        EXPECT_EQ(list[0].kind, Kind::scale_unknown);
        EXPECT_EQ(list[0].cause, watch.state().problem);
        EXPECT_EQ(list[1].kind, Kind::colours_unknown);
    };
    {
        DesktopWatch watch(true);
        EXPECT_NE(watch.state().problem.find("there is no session bus"), std::string::npos);
        unnamed(watch);
    }
    {
        FakeDesktopBus bus("org.kde.KWin");
        DesktopWatch watch(true);
        EXPECT_NE(watch.state().problem.find("is not GNOME's"), std::string::npos);
        unnamed(watch);
    }
    FakeDesktopBus bus(kMutter);
    DesktopWatch watch(true);
    EXPECT_EQ(watch.state().problem,
              "GNOME does not tell its monitors (org.gnome.Mutter.DisplayConfig: no monitors "
              "today).");
    unnamed(watch);
    auto wrong = said_of_desktop();
    wrong.logical_monitors[1].transform = 9;
    bus.tell_monitors(wrong);
    EXPECT_TRUE(wait_until([&] {
        return watch.state().problem.find("transform: found 9, expected 0 to 7") !=
               std::string::npos;
    }));
    unnamed(watch);
    // What Mutter told once is still what it told last.
    bus.tell_monitors(said_of_desktop());
    EXPECT_TRUE(wait_until([&] { return watch.state().problem.empty(); }));
    bus.tell_monitors(std::nullopt);
    EXPECT_TRUE(wait_until([&] { return !watch.state().problem.empty(); }));
    EXPECT_EQ(list_monitors(&watch)[1].id, id_of_projector());
}

TEST_F(DesktopWatchTest, WaitsForNobodyAndHearsTheLateAnswer) {
    FakeDesktopBus bus(kMutter);
    bus.tell_monitors(said_of_desktop());
    bus.answers = false;
    std::atomic<int> changes{0};
    DesktopWatch watch(true, [&] { ++changes; });
    EXPECT_FALSE(watch.state().mutter);
    EXPECT_FALSE(watch.state().problem.empty());
    EXPECT_EQ(list_monitors(&watch)[1].id, "DUMMY1");
    bus.answers = true;
    EXPECT_TRUE(wait_until([&] { return watch.state().mutter.has_value(); }));
    EXPECT_GE(changes, 1);
    EXPECT_EQ(list_monitors(&watch)[1].id, id_of_projector());
}

TEST_F(DesktopWatchTest, OutlivesItsBus) {
    auto bus = std::make_unique<FakeDesktopBus>(kMutter);
    bus->tell_monitors(said_of_desktop());
    DesktopWatch watch(true);
    EXPECT_TRUE(watch.state().mutter);
    bus.reset();
    EXPECT_TRUE(wait_until([&] { return !watch.state().problem.empty(); }));
    EXPECT_EQ(list_monitors(&watch)[1].id, id_of_projector());
}

TEST_F(DesktopWatchTest, LetsTheProjectorsWindowFollowItsMonitorByThatName) {
    FakeDesktopBus bus(kMutter);
    bus.tell_monitors(said_of_desktop());
    Stage stage;
    const auto watch = std::make_shared<DesktopWatch>(true);
    ProjectorScreen screen(stage.share, watch);
    screen.present(stage.plain(1, kMagenta));
    screen.use_monitor(id_of_projector());
    EXPECT_TRUE(stage.projector_becomes(kMagenta));
    stage.desktop.unplug_projector();
    EXPECT_TRUE(wait_until([&] {
        screen.monitors_changed();
        return screen.state() == ProjectorScreen::State::waiting_for_monitor;
    }));
    stage.desktop.plug_projector();
    EXPECT_TRUE(stage.projector_becomes(kMagenta));
}

}  // namespace
}  // namespace livery
