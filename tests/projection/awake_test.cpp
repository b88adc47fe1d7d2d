// Screens stay on while the projector shows something, and only then.
#include <gtest/gtest.h>
#include <xcb/screensaver.h>

#include "fake_desktop_bus.h"
#include "projection/check_signal.h"
#include "projection/outputs.h"
#include "projection/session_bus.h"
#include "stage.h"

namespace livery {
namespace {

bool is_blanked(const XConnection& x) {
    const XReply<xcb_screensaver_query_info_reply_t> info(xcb_screensaver_query_info_reply(
        x.get(), xcb_screensaver_query_info(x.get(), x.root()), nullptr));
    return info && info->state == XCB_SCREENSAVER_STATE_ON;
}

TEST(AwakeTest, TheServerDoesNotBlankWhileTheProjectorShows) {
    ::unsetenv("DBUS_SESSION_BUS_ADDRESS");
    Stage stage;
    const XConnection x;
    ProjectorScreen screen(stage.share);
    screen.use_monitor(Desktop::projector_output);
    // After one second without a key.
    xcb_set_screen_saver(x.get(), 1, 0, XCB_BLANKING_PREFERRED, XCB_EXPOSURES_ALLOWED);
    x.synchronise();
    sleep_ms(1800);
    EXPECT_FALSE(is_blanked(x));
    screen.use_monitor(std::nullopt);
    EXPECT_TRUE(wait_until([&] { return is_blanked(x); }));
    xcb_force_screen_saver(x.get(), XCB_SCREEN_SAVER_RESET);
    xcb_set_screen_saver(x.get(), -1, -1, XCB_BLANKING_DEFAULT, XCB_EXPOSURES_DEFAULT);
    x.synchronise();
}

TEST(AwakeTest, TheDesktopIsAskedAndToldWhenItIsOver) {
    Stage stage;
    FakeDesktopBus bus("org.freedesktop.ScreenSaver");
    {
        ProjectorScreen screen(stage.share);
        EXPECT_EQ(bus.inhibitions, 0);
        screen.use_monitor(Desktop::projector_output);
        EXPECT_TRUE(wait_until([&] { return bus.inhibitions == 1; }));
        stage.desktop.unplug_projector();
        EXPECT_TRUE(wait_until([&] { return bus.inhibitions == 0; }));
        stage.desktop.plug_projector();
        EXPECT_TRUE(wait_until([&] { return bus.inhibitions == 1; }));
    }
    EXPECT_EQ(bus.inhibitions, 0);
}

TEST(AwakeTest, ADesktopThatDoesNotAnswerHoldsNothingUp) {
    Stage stage;
    FakeDesktopBus bus("org.freedesktop.ScreenSaver");
    bus.answers = false;
    ProjectorScreen screen(stage.share);
    screen.present(stage.plain(1, kMagenta));
    screen.use_monitor(Desktop::projector_output);
    EXPECT_TRUE(stage.projector_becomes(kMagenta));
}

TEST(NightLightTest, IsAskedOfTheDesktop) {
    const Desktop desktop;
    const auto monitor = find_monitor(list_monitors(), Desktop::projector_output);
    ASSERT_TRUE(monitor);
    for (const auto& [service, name] :
         {std::pair("org.gnome.SettingsDaemon.Color", "GNOME"), {"org.kde.KWin", "KDE Plasma"}}) {
        FakeDesktopBus bus(service);
        const auto check = [&] {
            DesktopWatch desktop_watch(false);
            return check_signal(*monitor, {0, 0}, desktop_watch);
        };
        EXPECT_TRUE(check().empty());
        bus.property = true;
        const auto list = check();
        ASSERT_EQ(list.size(), 1u);
        EXPECT_EQ(list[0].kind, SignalWarning::Kind::night_light);
        EXPECT_EQ(list[0].what, "A night light tints the projector's picture.");
        EXPECT_EQ(list[0].cause, name + std::string(" says that its night light is on."));
        EXPECT_EQ(list[0].fix, "Switch the night light off in the display settings.");
        bus.answers = false;
        EXPECT_TRUE(check().empty());
    }
}

TEST(SessionBusTest, IsOptional) {
    ::unsetenv("DBUS_SESSION_BUS_ADDRESS");
    ::setenv("XDG_RUNTIME_DIR", "/nonexistent", 1);
    EXPECT_EQ(SessionBus::connect(), nullptr);
    for (const char* address : {"unix:path=/nonexistent/bus", "nonsense", "unix:path=/dev/null"}) {
        ::setenv("DBUS_SESSION_BUS_ADDRESS", address, 1);
        EXPECT_EQ(SessionBus::connect(), nullptr) << address;
    }
    ::unsetenv("DBUS_SESSION_BUS_ADDRESS");
}

}  // namespace
}  // namespace livery
