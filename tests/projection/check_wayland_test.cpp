// What is said of a projector behind Xwayland.
#include <gtest/gtest.h>

#include "projection/check_signal.h"
#include "projection/outputs.h"

namespace livery {
namespace {

using Kind = SignalWarning::Kind;
using Severity = SignalWarning::Severity;

/// A projector of 1920x1080 that shows so much of the desktop.
Output projector_showing(glm::ivec2 shown_px, double scale, int transform = 0) {
    Output output;
    output.socket = "HDMI-1";
    output.behind_wayland = true;
    output.turned = transform % 2 != 0;
    output.preferred_px = output.monitor.mode_px = {1920, 1080};
    output.monitor.width = shown_px.x;
    output.monitor.height = shown_px.y;
    output.monitor.wayland = WaylandOutput{scale, transform};
    return output;
}

DesktopState desktop_with(NightLight night_light) {
    DesktopState state;
    state.night_light = night_light;
    if (night_light != NightLight::unknown) state.night_light_of = "GNOME";
    return state;
}

/// The only warning beside the note about colours.
SignalWarning only_warning(const Output& output, const DesktopState& desktop = {}) {
    auto list = warnings_behind_wayland(output, desktop);
    const auto sizes = warnings_of_size(output, {0, 0});
    list.insert(list.end(), sizes.begin(), sizes.end());
    std::erase_if(list, [](const SignalWarning& w) { return w.kind == Kind::colours_unknown; });
    EXPECT_EQ(list.size(), 1u);
    return list.empty() ? SignalWarning() : list.front();
}

TEST(WarningsBehindWayland, SayThatColoursCannotBeKnown) {
    const auto output = projector_showing({1920, 1080}, 1.0);
    const auto list = warnings_behind_wayland(output, desktop_with(NightLight::unknown));
    ASSERT_EQ(list.size(), 1u);
    EXPECT_EQ(list[0].kind, Kind::colours_unknown);
    EXPECT_EQ(list[0].severity, Severity::note);
    EXPECT_EQ(list[0].what, "Nothing here tells what the desktop does to the projector's colours.");
    EXPECT_NE(list[0].fix.find("that Night Light is off and no colour profile"), std::string::npos)
        << list[0].fix;
    const auto off = warnings_behind_wayland(output, desktop_with(NightLight::off));
    ASSERT_EQ(off.size(), 1u);
    EXPECT_NE(off[0].cause.find("; GNOME says that its night light is off."), std::string::npos)
        << off[0].cause;
    EXPECT_EQ(off[0].fix.find("Night Light"), std::string::npos) << off[0].fix;
    EXPECT_TRUE(warnings_of_size(output, {1920, 1080}).empty());
}

TEST(WarningsBehindWayland, SayThatANightLightIsOn) {
    const auto warning =
        only_warning(projector_showing({1920, 1080}, 1.0), desktop_with(NightLight::on));
    EXPECT_EQ(warning.kind, Kind::night_light);
    EXPECT_EQ(warning.severity, Severity::warning);
    EXPECT_EQ(warning.cause, "GNOME says that its night light is on.");
}

TEST(WarningsBehindWayland, CallAScaleThatBlursAnError) {
    const auto warning = only_warning(projector_showing({1280, 720}, 1.5));
    EXPECT_EQ(warning.kind, Kind::scaled);
    EXPECT_EQ(warning.severity, Severity::error);
    EXPECT_EQ(warning.what, "The desktop scales the picture on its way to the projector.");
    EXPECT_EQ(warning.cause,
              "HDMI-1 shows 1280x720 of the desktop with 1920x1080 pixels, at GNOME's scale of "
              "150%.");
    EXPECT_EQ(warning.fix,
              "In GNOME's Settings, Displays (`gnome-control-center display`), choose this display "
              "and set Scale to 100%.");
    // Xwayland in pixels of twice the desktop's, shown on less.
    EXPECT_EQ(only_warning(projector_showing({2560, 1440}, 1.5)).severity, Severity::error);
}

TEST(WarningsBehindWayland, CallAScaleThatBlursNothingAWarning) {
    const auto warning = only_warning(projector_showing({1920, 1080}, 2.0));
    EXPECT_EQ(warning.kind, Kind::scaled);
    EXPECT_EQ(warning.severity, Severity::warning);
    EXPECT_EQ(warning.what, "The projector's display has a scale.");
    EXPECT_NE(warning.cause.find("HDMI-1 at a scale of 200%"), std::string::npos) << warning.cause;
}

TEST(WarningsBehindWayland, CallATurnAnError) {
    auto warning = only_warning(projector_showing({1080, 1920}, 1.0, 1));
    EXPECT_EQ(warning.kind, Kind::turned);
    EXPECT_EQ(warning.severity, Severity::error);
    EXPECT_EQ(warning.cause, "GNOME turns by 90° what HDMI-1 shows.");
    EXPECT_NE(warning.fix.find("set Orientation to Landscape"), std::string::npos) << warning.fix;
    warning = only_warning(projector_showing({1920, 1080}, 1.0, 4));
    EXPECT_EQ(warning.cause, "GNOME mirrors what HDMI-1 shows.");
    EXPECT_EQ(warnings_behind_wayland(projector_showing({720, 1280}, 1.5, 3), {}).size() +
                  warnings_of_size(projector_showing({720, 1280}, 1.5, 3), {0, 0}).size(),
              3u)
        << "turned, scaled, and the note";
}

TEST(WarningsBehindWayland, SayThatColoursAreConverted) {
    auto output = projector_showing({1920, 1080}, 1.0);
    output.monitor.wayland->colour_mode = 1;
    const auto warning = only_warning(output);
    EXPECT_EQ(warning.kind, Kind::colour_mode);
    EXPECT_EQ(warning.severity, Severity::warning);
    EXPECT_EQ(warning.cause, "GNOME drives HDMI-1 with high dynamic range (HDR).");
}

TEST(WarningsBehindWayland, SayWhenTheScaleIsNotKnown) {
    auto output = projector_showing({1280, 720}, 1.0);
    output.socket = "XWAYLAND1";
    output.monitor.wayland.reset();
    output.monitor.mode_px = output.preferred_px = {0, 0};
    auto warning = only_warning(output);
    EXPECT_EQ(warning.kind, Kind::scale_unknown);
    EXPECT_EQ(warning.severity, Severity::warning);
    EXPECT_EQ(warning.cause,
              "None of the monitors that GNOME tells lies where XWAYLAND1 does, or more than one.");
    DesktopState silent;
    silent.problem = "This Wayland desktop is not GNOME's.";
    warning = only_warning(output, silent);
    EXPECT_EQ(warning.cause, silent.problem);
    // Known once, and not any more.
    EXPECT_EQ(only_warning(projector_showing({1920, 1080}, 1.0), silent).kind, Kind::scale_unknown);
}

TEST(WarningsBehindWayland, NameNoXrandr) {
    auto output = projector_showing({1280, 720}, 1.0);
    output.monitor.mode_px = {1280, 720};
    const auto list = warnings_of_size(output, {0, 0});
    ASSERT_EQ(list.size(), 1u);
    EXPECT_EQ(list[0].fix, "Choose 1920x1080 in the display settings.");
}

}  // namespace
}  // namespace livery
