// What a Wayland compositor does to the projector's picture behind Xwayland's back.
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "projection/check_signal.h"

namespace livery {
namespace {

using Kind = SignalWarning::Kind;
using Severity = SignalWarning::Severity;

void check_scale(const Output& output, double scale, std::vector<SignalWarning>& list) {
    if (std::abs(scale - 1.0) < 1e-6 || is_scaled(output)) return;
    list.push_back({Kind::scaled,
                    "The projector's display has a scale.",
                    fmt::format("GNOME shows {} at a scale of {:.0f}%. Its pixels reach the "
                                "projector one to one as things are; with other settings they "
                                "would not.",
                                output.socket,
                                100.0 * scale),
                    std::string(kInDisplaySettings) + "set Scale to 100%."});
}

void check_transform(const Output& output, int transform, std::vector<SignalWarning>& list) {
    if (transform == 0) return;
    constexpr std::array<const char*, 8> kDone = {"",
                                                  "turns by 90°",
                                                  "turns by 180°",
                                                  "turns by 270°",
                                                  "mirrors",
                                                  "mirrors and turns by 90°",
                                                  "mirrors and turns by 180°",
                                                  "mirrors and turns by 270°"};
    list.push_back(
        {Kind::turned,
         "The desktop turns the projector's picture.",
         fmt::format(
             "GNOME {} what {} shows.", kDone[static_cast<std::size_t>(transform)], output.socket),
         std::string(kInDisplaySettings) +
             "set Orientation to Landscape; a projector that hangs upside down turns "
             "its picture by itself.",
         Severity::error});
}

void check_colour_mode(const Output& output, unsigned mode, std::vector<SignalWarning>& list) {
    if (mode == 0) return;
    list.push_back({Kind::colour_mode,
                    "The desktop converts the projector's colours.",
                    fmt::format("GNOME drives {} with {}.",
                                output.socket,
                                mode == 1 ? "high dynamic range (HDR)"
                                          : fmt::format("colour mode {}, not 0", mode)),
                    std::string(kInDisplaySettings) + "switch HDR off."});
}

void check_night_light(const DesktopState& desktop, std::vector<SignalWarning>& list) {
    if (desktop.night_light == NightLight::on) {
        list.push_back({Kind::night_light,
                        "A night light tints the projector's picture.",
                        desktop.night_light_of + " says that its night light is on.",
                        "Switch the night light off in the display settings."});
    }
    const bool is_off = desktop.night_light == NightLight::off;
    list.push_back(
        {Kind::colours_unknown,
         "Nothing here tells what the desktop does to the projector's colours.",
         "On a Wayland desktop no program can read or set the graphics card's gamma table, the "
         "colour profile or the range of levels" +
             (is_off ? "; " + desktop.night_light_of + " says that its night light is off." : "."),
         std::string("Check in the settings that ") + (is_off ? "" : "Night Light is off and ") +
             "no colour profile is chosen for this display. Projector > Test picture shows the "
             "range. In an Xorg session Livery looks for all of these.",
         Severity::note});
}

}  // namespace

std::vector<SignalWarning> warnings_behind_wayland(const Output& output,
                                                   const DesktopState& desktop) {
    std::vector<SignalWarning> list;
    if (const auto& wayland = output.monitor.wayland) {
        check_scale(output, wayland->scale, list);
        check_transform(output, wayland->transform, list);
        check_colour_mode(output, wayland->colour_mode, list);
    }
    if (!output.monitor.wayland || !desktop.problem.empty()) {
        list.push_back({Kind::scale_unknown,
                        "Nothing tells at which scale the desktop shows the projector's picture.",
                        !desktop.problem.empty()
                            ? desktop.problem
                            : "None of the monitors that GNOME tells lies where " + output.socket +
                                  " does, or more than one.",
                        "Check in the display settings that this display has a scale of 100% and "
                        "is not turned."});
    }
    check_night_light(desktop, list);
    return list;
}

}  // namespace livery
