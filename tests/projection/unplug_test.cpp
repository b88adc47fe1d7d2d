// The projector goes away and comes back: nothing of its picture may be seen by the operator.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <optional>
#include <thread>

#include <gtest/gtest.h>
#include <xcb/randr.h>

#include "operator_watch.h"
#include "stage.h"

namespace livery {
namespace {

using State = ProjectorScreen::State;

struct UnplugTest : ::testing::TestWithParam<bool> {
    Stage stage{GetParam()};
    std::string projector = Desktop::projector_output;

    std::vector<std::string> window_titles() const {
        std::vector<std::string> titles;
        for (const auto& window : stage.desktop.windows()) titles.push_back(window.title);
        return titles;
    }
    bool is_up() const {
        const auto titles = window_titles();
        return std::count(titles.begin(), titles.end(), "Livery projector") == 1;
    }
};

TEST_P(UnplugTest, HidesWithoutTheMainThreadAndComesBackWithTheNewest) {
    ProjectorScreen screen(stage.share);
    screen.present(stage.plain(1, kMagenta));
    screen.use_monitor(projector);
    ASSERT_TRUE(stage.projector_becomes(kMagenta));
    {
        const OperatorWatch watch(Desktop::operator_output, kMagenta);
        ASSERT_TRUE(wait_until([&] { return watch.looks() > 10; }));
        stage.desktop.unplug_projector();
        EXPECT_TRUE(wait_until([&] { return screen.state() == State::waiting_for_monitor; }));
        EXPECT_FALSE(is_up());
        const int looks = watch.looks();
        EXPECT_TRUE(wait_until([&] { return watch.looks() > looks + 10; }));
        EXPECT_EQ(watch.wrong(), 0) << "of " << watch.looks();
    }
    EXPECT_EQ(screen.why_waiting(),
              "The projector is unplugged or switched off in the display settings.");
    EXPECT_TRUE(screen.monitors_changed());
    EXPECT_FALSE(screen.monitors_changed());
    screen.present(stage.plain(2, kGreen));
    stage.desktop.plug_projector();
    EXPECT_TRUE(stage.projector_becomes(kGreen));
    EXPECT_TRUE(screen.monitors_changed());
    EXPECT_EQ(screen.state(), State::showing);
    EXPECT_EQ(screen.why_waiting(), "");
}

TEST_P(UnplugTest, IsNotSeenWhenTheOperatorsMonitorTakesItsPlace) {
    ProjectorScreen screen(stage.share);
    screen.present(stage.plain(1, kMagenta));
    screen.use_monitor(projector);
    for (int round = 0; round < 5; ++round) {
        stage.desktop.plug_projector(Desktop::Side::left);
        ASSERT_TRUE(stage.projector_becomes(kMagenta)) << round;
        const OperatorWatch watch(Desktop::operator_output, kMagenta);
        ASSERT_TRUE(wait_until([&] { return watch.looks() > 10; }));
        stage.desktop.xrandr({"--output",
                              Desktop::projector_output,
                              "--off",
                              "--output",
                              Desktop::operator_output,
                              "--pos",
                              "0x0"});
        EXPECT_TRUE(wait_until([&] { return screen.state() == State::waiting_for_monitor; }));
        const int looks = watch.looks();
        EXPECT_TRUE(wait_until([&] { return watch.looks() > looks + 10; }));
        EXPECT_EQ(watch.wrong(), 0) << "round " << round << ", of " << watch.looks();
        EXPECT_EQ(watch.places(), 2);
    }
}

TEST_P(UnplugTest, IsHiddenWhileTheMonitorsShowTheSame) {
    ProjectorScreen screen(stage.share);
    screen.present(stage.plain(1, kMagenta));
    screen.use_monitor(projector);
    ASSERT_TRUE(stage.projector_becomes(kMagenta));
    stage.desktop.xrandr(
        {"--output", Desktop::projector_output, "--same-as", Desktop::operator_output});
    // The outputs change one after the other.
    EXPECT_TRUE(wait_until([&] {
        return screen.why_waiting() ==
               "The projector mirrors DUMMY0; set the displays to extend the desktop.";
    })) << screen.why_waiting();
    EXPECT_EQ(screen.state(), State::waiting_for_monitor);
    EXPECT_FALSE(is_up());
    stage.desktop.plug_projector();
    EXPECT_TRUE(stage.projector_becomes(kMagenta));
}

TEST_P(UnplugTest, KeepsBlackAndFrozenWhileAway) {
    ProjectorScreen screen(stage.share);
    screen.use_monitor(projector);
    screen.present(stage.plain(1, kMagenta));
    ASSERT_TRUE(stage.projector_becomes(kMagenta));
    screen.set_frozen(true);
    stage.desktop.unplug_projector();
    ASSERT_TRUE(wait_until([&] { return screen.state() == State::waiting_for_monitor; }));
    screen.present(stage.plain(2, kGreen));
    stage.desktop.plug_projector();
    EXPECT_TRUE(stage.projector_becomes(kMagenta));
    screen.set_black(true);
    ASSERT_TRUE(stage.projector_becomes(kBlack));
    stage.desktop.unplug_projector();
    ASSERT_TRUE(wait_until([&] { return screen.state() == State::waiting_for_monitor; }));
    screen.set_frozen(false);
    stage.desktop.plug_projector();
    ASSERT_TRUE(wait_until([&] { return is_up(); }));
    sleep_ms(50);
    EXPECT_EQ(stage.on_projector(), kBlack);
    screen.set_black(false);
    EXPECT_TRUE(stage.projector_becomes(kGreen));
}

TEST_P(UnplugTest, TakesTheResolutionThatTheProjectorComesBackWith) {
    ProjectorScreen screen(stage.share);
    screen.present(stage.plain(1, kMagenta));
    screen.use_monitor(projector);
    ASSERT_TRUE(stage.projector_becomes(kMagenta));
    stage.desktop.xrandr({"--addmode", Desktop::projector_output, "1024x768"});
    stage.desktop.xrandr({"--output", Desktop::projector_output, "--mode", "1024x768"});
    const Rectangle area = stage.desktop.projector_area();
    ASSERT_EQ(area.width, 1024);
    EXPECT_TRUE(stage.projector_becomes(kMagenta));
    // 1280x800 as large as fits: 1024x640 in the middle.
    EXPECT_TRUE(wait_until([&] { return stage.desktop.pixel(area.x, 64) == kMagenta; }));
    EXPECT_EQ(stage.desktop.pixel(area.x, 63), kBlack);
    EXPECT_EQ(stage.desktop.pixel(area.x + 1023, 64 + 639), kMagenta);
    EXPECT_EQ(stage.desktop.pixel(area.x + 1023, 64 + 640), kBlack);
}

TEST_P(UnplugTest, AMonitorThatWasNeverThereIsWaitedFor) {
    ProjectorScreen screen(stage.share);
    screen.use_monitor("HDMI-7:0123456789abcdef");
    EXPECT_EQ(screen.state(), State::waiting_for_monitor);
    EXPECT_FALSE(is_up());
    screen.use_monitor(projector);
    EXPECT_EQ(screen.state(), State::showing);
    EXPECT_TRUE(is_up());
}

TEST_P(UnplugTest, ManyPicturesFromManyThreadsWhileItGoesAndComes) {
    ProjectorScreen screen(stage.share);
    screen.use_monitor(projector);
    std::vector<std::shared_ptr<const ProjectorPicture>> pictures;
    for (std::uint64_t i = 1; i <= 8; ++i) {
        pictures.push_back(stage.plain(i, {static_cast<int>(20 * i), 7, 7}, {320, 200}));
    }
    std::atomic<bool> over{false};
    std::vector<std::thread> threads;
    for (int t = 0; t < 3; ++t) {
        threads.emplace_back([&, t] {
            for (std::size_t i = 0; !over; ++i) {
                screen.present(pictures[(i + static_cast<std::size_t>(t)) % pictures.size()]);
                if (i % 7 == 0) screen.set_black(i % 2 == 0);
                if (i % 11 == 0) screen.set_frozen(i % 2 == 0);
                sleep_ms(1);
            }
        });
    }
    for (int round = 0; round < 4; ++round) {
        stage.desktop.unplug_projector();
        stage.desktop.plug_projector(round % 2 == 0 ? Desktop::Side::left : Desktop::Side::right);
    }
    over = true;
    for (auto& thread : threads) thread.join();
    screen.set_frozen(false);
    screen.set_black(false);
    screen.present(stage.plain(100, kGreen));
    EXPECT_TRUE(stage.projector_becomes(kGreen));
    EXPECT_TRUE(wait_until([&] { return screen.shown().number == 100; }));
}

/// Nothing between the server's word about the monitor and the window's end can be asserted of a
/// machine with other work; this prints it.
TEST_P(UnplugTest, TellsHowSoonItHides) {
    ProjectorScreen screen(stage.share);
    screen.use_monitor(projector);
    constexpr int kRounds = 11;
    std::vector<double> delays_ms;
    for (int round = 0; round < kRounds; ++round) {
        const XConnection x;
        xcb_randr_select_input(x.get(), x.root(), XCB_RANDR_NOTIFY_MASK_CRTC_CHANGE);
        const std::uint32_t mask = XCB_EVENT_MASK_SUBSTRUCTURE_NOTIFY;
        xcb_change_window_attributes(x.get(), x.root(), XCB_CW_EVENT_MASK, &mask);
        x.synchronise();
        const auto randr_event = xcb_get_extension_data(x.get(), &xcb_randr_id)->first_event;
        std::optional<std::chrono::steady_clock::time_point> off, hidden;
        std::thread ears([&] {
            while (!hidden) {
                const XReply<xcb_generic_event_t> event(xcb_wait_for_event(x.get()));
                if (!event) return;
                const auto now = std::chrono::steady_clock::now();
                if (event->response_type == randr_event + XCB_RANDR_NOTIFY && !off) off = now;
                if (event->response_type == XCB_UNMAP_NOTIFY) hidden = now;
            }
        });
        stage.desktop.unplug_projector();
        ears.join();
        ASSERT_TRUE(off && hidden);
        delays_ms.push_back(std::chrono::duration<double, std::milli>(*hidden - *off).count());
        stage.desktop.plug_projector();
        ASSERT_TRUE(wait_until([&] { return is_up(); }));
    }
    std::sort(delays_ms.begin(), delays_ms.end());
    std::printf("hidden %.2f ms after the server's word (median of %d; worst %.2f ms)\n",
                delays_ms[kRounds / 2],
                kRounds,
                delays_ms.back());
}

INSTANTIATE_TEST_SUITE_P(Desktops, UnplugTest, ::testing::Bool(), [](const auto& parameter) {
    return parameter.param ? "openbox" : "bare";
});

}  // namespace
}  // namespace livery
