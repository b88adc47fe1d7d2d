// What would change the projector's picture behind our back.
#include "projection/check_signal.h"

#include <array>
#include <stdexcept>

#include <gtest/gtest.h>
#include <xcb/randr.h>

#include "projection/monitors.h"
#include "projection/outputs.h"
#include "support/desktop.h"

namespace livery {
namespace {

using Kind = SignalWarning::Kind;

struct CheckSignalTest : ::testing::Test {
    CheckSignalTest() { ::unsetenv("DBUS_SESSION_BUS_ADDRESS"); }

    std::vector<SignalWarning> check(glm::ivec2 calibrated_px = {1280, 800}) const {
        const auto monitor = find_monitor(list_monitors(), Desktop::projector_output);
        return monitor ? check_signal(*monitor, calibrated_px, watch)
                       : std::vector<SignalWarning>();
    }
    mutable DesktopWatch watch{false};
    Desktop desktop;
    std::string projector = Desktop::projector_output;
};

std::string text(const SignalWarning& warning) {
    return warning.what + "\n" + warning.cause + "\n" + warning.fix;
}

TEST_F(CheckSignalTest, SaysNothingWhenAllIsWell) {
    for (const auto& warning : check()) ADD_FAILURE() << text(warning);
    for (const auto& warning : check({0, 0})) ADD_FAILURE() << text(warning);
}

TEST_F(CheckSignalTest, FindsAGammaSetting) {
    desktop.xrandr({"--output", projector, "--gamma", "1.4:1.4:1.4"});
    const auto list = check();
    ASSERT_EQ(list.size(), 1u);
    EXPECT_EQ(list[0].kind, Kind::gamma_ramp);
    EXPECT_EQ(list[0].what, "A gamma setting or a colour profile changes the projector's picture.");
    EXPECT_EQ(list[0].cause,
              "The graphics card's table for DUMMY1 turns the grey level 128 into 156, 156, 156.");
    EXPECT_EQ(list[0].fix,
              "Take the colour profile off this display in the colour settings, or run `xrandr "
              "--output DUMMY1 --gamma 1:1:1 --brightness 1`.");
    // The fix fixes it.
    desktop.xrandr({"--output", projector, "--gamma", "1:1:1", "--brightness", "1"});
    EXPECT_TRUE(check().empty());
    desktop.xrandr({"--output", Desktop::operator_output, "--gamma", "1:0.8:0.6"});
    EXPECT_TRUE(check().empty()) << "the operator's monitor may have what it likes";
}

TEST_F(CheckSignalTest, FindsANightLightByItsColour) {
    desktop.xrandr({"--output", projector, "--gamma", "1:0.8:0.6"});
    const auto list = check();
    ASSERT_EQ(list.size(), 1u);
    EXPECT_EQ(list[0].kind, Kind::night_light);
    EXPECT_EQ(list[0].what, "A night light tints the projector's picture.");
    EXPECT_EQ(list[0].cause,
              "The graphics card leaves 75% of the blue on DUMMY1, as a night light does.");
    EXPECT_EQ(list[0].fix,
              "Switch the night light off in the display settings, or run `xrandr --output DUMMY1 "
              "--gamma 1:1:1 --brightness 1`.");
}

TEST_F(CheckSignalTest, FindsALimitedRangeWhereTheDriverTells) {
    const XConnection x;
    const auto set = [&](std::string_view value) {
        const xcb_atom_t atom = x.atom(value);
        for (const auto& output : read_outputs(x, nullptr)) {
            if (output.socket != projector) continue;
            xcb_randr_change_output_property(x.get(),
                                             output.output,
                                             x.atom("Broadcast RGB"),
                                             XCB_ATOM_ATOM,
                                             32,
                                             XCB_PROP_MODE_REPLACE,
                                             1,
                                             &atom);
        }
        x.synchronise();
    };
    set("Full");
    EXPECT_TRUE(check().empty());
    set("Limited 16:235");
    const auto list = check();
    ASSERT_EQ(list.size(), 1u);
    EXPECT_EQ(list[0].kind, Kind::limited_range);
    EXPECT_EQ(list[0].what, "The signal to the projector has a limited range of levels.");
    EXPECT_EQ(list[0].cause,
              "\"Broadcast RGB\" of DUMMY1 is \"Limited 16:235\", so black and white leave as dark "
              "and light grey.");
    EXPECT_EQ(list[0].fix,
              "Run `xrandr --output DUMMY1 --set \"Broadcast RGB\" Full`, and set the projector's "
              "input to full range (0-255), too.");
}

TEST_F(CheckSignalTest, FindsAnotherSizeThanTheCalibrations) {
    const auto list = check({1920, 1080});
    ASSERT_EQ(list.size(), 1u);
    EXPECT_EQ(list[0].kind, Kind::scaled);
    EXPECT_EQ(list[0].what, "The picture does not fit the calibration.");
    EXPECT_EQ(list[0].cause, "The calibration was made at 1920x1080, and DUMMY1 shows 1280x800.");
    EXPECT_EQ(list[0].fix, "Set the display to 1920x1080, or calibrate again.");
}

Output output_showing(glm::ivec2 desktop_px, glm::ivec2 mode_px, glm::ivec2 preferred_px) {
    Output output;
    output.socket = "HDMI-1";
    output.monitor.width = desktop_px.x;
    output.monitor.height = desktop_px.y;
    output.monitor.mode_px = mode_px;
    output.preferred_px = preferred_px;
    return output;
}

TEST(WarningsOfSize, SayWhetherTheDesktopScales) {
    auto output = output_showing({1600, 900}, {1920, 1080}, {1920, 1080});
    output.transformed = true;
    auto list = warnings_of_size(output, {0, 0});
    ASSERT_EQ(list.size(), 1u);
    EXPECT_EQ(list[0].kind, Kind::scaled);
    EXPECT_EQ(list[0].severity, SignalWarning::Severity::error);
    EXPECT_EQ(list[0].what, "The desktop scales the picture on its way to the projector.");
    EXPECT_EQ(list[0].cause, "HDMI-1 shows 1600x900 of the desktop with 1920x1080 pixels.");
    EXPECT_EQ(
        list[0].fix,
        "Set the scale of this display to 100%, or run `xrandr --output HDMI-1 --scale 1x1`.");
    output = output_showing({1080, 1920}, {1920, 1080}, {1920, 1080});
    EXPECT_EQ(warnings_of_size(output, {0, 0}).size(), 1u);
    output.turned = true;
    EXPECT_TRUE(warnings_of_size(output, {0, 0}).empty());
}

TEST(WarningsOfSize, SayWhetherTheProjectorScales) {
    const auto list =
        warnings_of_size(output_showing({1280, 720}, {1280, 720}, {1920, 1080}), {1280, 720});
    ASSERT_EQ(list.size(), 1u);
    EXPECT_EQ(list[0].kind, Kind::scaled);
    EXPECT_EQ(list[0].what,
              "The projector does not get its own resolution and scales the picture.");
    EXPECT_EQ(list[0].cause, "HDMI-1 is set to 1280x720, and the projector asks for 1920x1080.");
    EXPECT_EQ(list[0].fix,
              "Choose 1920x1080 in the display settings, or run `xrandr --output HDMI-1 --mode "
              "1920x1080`.");
    EXPECT_TRUE(
        warnings_of_size(output_showing({1280, 720}, {1280, 720}, {0, 0}), {1280, 720}).empty());
}

TEST_F(CheckSignalTest, KnowsNothingOfAProjectorThatIsNotThere) {
    const auto monitor = find_monitor(list_monitors(), projector);
    ASSERT_TRUE(monitor);
    desktop.unplug_projector();
    EXPECT_TRUE(check_signal(*monitor, {1, 1}, watch).empty());
}

TEST(SignalTestPicture, HasEveryStepNearBlackAndNearWhite) {
    for (const glm::ivec2 size :
         {glm::ivec2(1280, 800), glm::ivec2(64, 64), glm::ivec2(3840, 2160)}) {
        const auto picture = signal_test_picture(size.x, size.y);
        ASSERT_EQ(picture.width, size.x);
        ASSERT_EQ(picture.height, size.y);
        ASSERT_EQ(picture.channels, 3);
        for (int i = 0; i < 7; ++i) {
            const int x = size.x * (2 * i + 1) / 14;
            const int dark = 4 * i, bright = 255 - 4 * i;
            EXPECT_EQ(colour_at(picture, x, size.y * 3 / 8), (Rgb{dark, dark, dark}));
            EXPECT_EQ(colour_at(picture, x, size.y * 7 / 8), (Rgb{bright, bright, bright}));
        }
        EXPECT_EQ(colour_at(picture, 1, 1), (Rgb{0, 0, 0}));
        EXPECT_EQ(colour_at(picture, size.x - 2, size.y - 2), (Rgb{255, 255, 255}));
        for (const int x : {0, size.x / 3, size.x - 1}) {
            EXPECT_EQ(colour_at(picture, x, 0), (Rgb{48, 48, 48}));
            EXPECT_EQ(colour_at(picture, x, size.y - 1), (Rgb{207, 207, 207}));
        }
        for (const int x : {0, size.x - 1}) {
            EXPECT_EQ(colour_at(picture, x, size.y / 3), (Rgb{48, 48, 48}));
            EXPECT_EQ(colour_at(picture, x, size.y * 2 / 3), (Rgb{207, 207, 207}));
        }
    }
    EXPECT_THROW(signal_test_picture(63, 800), std::invalid_argument);
    EXPECT_THROW(signal_test_picture(800, -1), std::invalid_argument);
}

}  // namespace
}  // namespace livery
