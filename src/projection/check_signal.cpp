#include "projection/check_signal.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <numeric>

#include <fmt/format.h>
#include <xcb/randr.h>

#include "projection/desktop_watch.h"
#include "projection/outputs.h"

namespace livery {

namespace {

using Kind = SignalWarning::Kind;
using Severity = SignalWarning::Severity;

std::string size_text(glm::ivec2 px) { return fmt::format("{}x{}", px.x, px.y); }

/// A graphics card's table, sampled where 8-bit levels are.
struct Ramp {
    std::vector<std::uint16_t> red, green, blue;
};

std::optional<Ramp> read_ramp(const XConnection& x, std::uint32_t crtc) {
    const XReply<xcb_randr_get_crtc_gamma_reply_t> reply(
        xcb_randr_get_crtc_gamma_reply(x.get(), xcb_randr_get_crtc_gamma(x.get(), crtc), nullptr));
    if (!reply || reply->size < 2) return std::nullopt;
    const auto copy = [&](const std::uint16_t* from) {
        return std::vector<std::uint16_t>(from, from + reply->size);
    };
    return Ramp{copy(xcb_randr_get_crtc_gamma_red(reply.get())),
                copy(xcb_randr_get_crtc_gamma_green(reply.get())),
                copy(xcb_randr_get_crtc_gamma_blue(reply.get()))};
}

double mean(const std::vector<std::uint16_t>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

/// What a channel's table makes of a level in [0, 255].
double applied(const std::vector<std::uint16_t>& table, double level) {
    const double at = level / 255.0 * static_cast<double>(table.size() - 1);
    return table[static_cast<std::size_t>(std::lround(at))] / 257.0;
}

bool is_identity(const std::vector<std::uint16_t>& table) {
    // Drivers write a level as level * 256 or level * 257: up to one level of 255 apart.
    constexpr double kTolerance = 1.1;
    for (std::size_t i = 0; i < table.size(); ++i) {
        const double level = 255.0 * static_cast<double>(i) / static_cast<double>(table.size() - 1);
        if (std::abs(table[i] / 257.0 - level) > kTolerance) return false;
    }
    return true;
}

/// Warmer light: less green than red and clearly less blue.
bool is_warm(const Ramp& ramp) {
    const double red = mean(ramp.red), green = mean(ramp.green), blue = mean(ramp.blue);
    return green <= red && blue <= green && blue < 0.95 * red;
}

void check_colours(const XConnection& x,
                   const Output& output,
                   const DesktopState& desktop,
                   std::vector<SignalWarning>& list) {
    const auto ramp = read_ramp(x, output.crtc);
    const bool changed =
        ramp && !(is_identity(ramp->red) && is_identity(ramp->green) && is_identity(ramp->blue));
    const bool says_so = desktop.night_light == NightLight::on;
    const std::string reset =
        fmt::format("run `xrandr --output {} --gamma 1:1:1 --brightness 1`.", output.socket);
    if (says_so || (changed && is_warm(*ramp))) {
        const std::string table =
            changed ? fmt::format("The graphics card leaves {:.0f}% of the blue on {}",
                                  100.0 * mean(ramp->blue) / mean(ramp->red),
                                  output.socket)
                    : std::string();
        list.push_back({Kind::night_light,
                        "A night light tints the projector's picture.",
                        says_so ? desktop.night_light_of + " says that its night light is on" +
                                      (changed ? "; t" + table.substr(1) : "") + "."
                                : table + ", as a night light does.",
                        "Switch the night light off in the display settings" +
                            (says_so ? std::string(".") : ", or " + reset)});
    } else if (changed) {
        list.push_back(
            {Kind::gamma_ramp,
             "A gamma setting or a colour profile changes the projector's picture.",
             fmt::format("The graphics card's table for {} turns the grey level 128 "
                         "into {:.0f}, {:.0f}, {:.0f}.",
                         output.socket,
                         applied(ramp->red, 128.0),
                         applied(ramp->green, 128.0),
                         applied(ramp->blue, 128.0)),
             "Take the colour profile off this display in the colour settings, or " + reset});
    }
}

void check_range(const XConnection& x, const Output& output, std::vector<SignalWarning>& list) {
    constexpr const char* kProperty = "Broadcast RGB";
    const auto value = output_property(x, output.output, kProperty);
    if (value.size() != sizeof(xcb_atom_t)) return;
    xcb_atom_t atom = 0;
    std::copy(value.begin(), value.end(), reinterpret_cast<std::uint8_t*>(&atom));
    const std::string choice = x.atom_name(atom);
    if (!choice.starts_with("Limited")) return;
    list.push_back({Kind::limited_range,
                    "The signal to the projector has a limited range of levels.",
                    fmt::format("\"{}\" of {} is \"{}\", so black and white leave as dark and "
                                "light grey.",
                                kProperty,
                                output.socket,
                                choice),
                    fmt::format("Run `xrandr --output {} --set \"{}\" Full`, and set the "
                                "projector's input to full range (0-255), too.",
                                output.socket,
                                kProperty)});
}

/// ", or run `xrandr ...`", where that does anything.
std::string or_xrandr(const Output& output, const std::string& what) {
    if (output.behind_wayland) return ".";
    return fmt::format(", or run `xrandr --output {} {}`.", output.socket, what);
}

}  // namespace

bool is_scaled(const Output& output) {
    const glm::ivec2 shown_px(output.monitor.width, output.monitor.height);
    const glm::ivec2 upright_px = output.turned ? glm::ivec2(shown_px.y, shown_px.x) : shown_px;
    return output.transformed ||
           (output.monitor.mode_px.x > 0 && upright_px != output.monitor.mode_px);
}

std::vector<SignalWarning> warnings_of_size(const Output& output, glm::ivec2 calibrated_px) {
    std::vector<SignalWarning> list;
    const glm::ivec2 shown_px(output.monitor.width, output.monitor.height);
    const glm::ivec2 mode_px = output.monitor.mode_px, best_px = output.preferred_px;
    if (best_px.x > 0 && best_px != mode_px) {
        list.push_back({Kind::scaled,
                        "The projector does not get its own resolution and scales the picture.",
                        fmt::format("{} is set to {}, and the projector asks for {}.",
                                    output.socket,
                                    size_text(mode_px),
                                    size_text(best_px)),
                        fmt::format("Choose {} in the display settings", size_text(best_px)) +
                            or_xrandr(output, "--mode " + size_text(best_px))});
    }
    if (is_scaled(output)) {
        const auto& wayland = output.monitor.wayland;
        list.push_back(
            {Kind::scaled,
             "The desktop scales the picture on its way to the projector.",
             fmt::format("{} shows {} of the desktop with {} pixels{}.",
                         output.socket,
                         size_text(shown_px),
                         size_text(mode_px),
                         wayland
                             ? fmt::format(", at GNOME's scale of {:.0f}%", 100.0 * wayland->scale)
                             : ""),
             wayland ? std::string(kInDisplaySettings) + "set Scale to 100%."
                     : "Set the scale of this display to 100%" + or_xrandr(output, "--scale 1x1"),
             Severity::error});
    }
    if (calibrated_px.x > 0 && calibrated_px.y > 0 && calibrated_px != shown_px) {
        list.push_back(
            {Kind::scaled,
             "The picture does not fit the calibration.",
             fmt::format("The calibration was made at {}, and {} shows {}.",
                         size_text(calibrated_px),
                         output.socket,
                         size_text(shown_px)),
             fmt::format("Set the display to {}, or calibrate again.", size_text(calibrated_px))});
    }
    return list;
}

const char* name_of(SignalWarning::Severity severity) {
    switch (severity) {
        case Severity::note:
            return "note";
        case Severity::warning:
            return "warning";
        case Severity::error:
            return "error";
    }
    return "";
}

std::vector<SignalWarning> check_signal(const Monitor& monitor,
                                        glm::ivec2 calibrated_px,
                                        DesktopWatch& desktop) {
    const XConnection x;
    const DesktopState state = desktop.state();
    std::vector<SignalWarning> list;
    for (const auto& output : read_outputs(x, &desktop)) {
        if (output.monitor.id != monitor.id) continue;
        if (output.behind_wayland) {
            list = warnings_behind_wayland(output, state);
        } else {
            check_colours(x, output, state, list);
            check_range(x, output, list);
        }
        const auto sizes = warnings_of_size(output, calibrated_px);
        list.insert(list.end(), sizes.begin(), sizes.end());
    }
    std::stable_sort(list.begin(), list.end(), [](const auto& a, const auto& b) {
        return a.severity > b.severity;
    });
    return list;
}

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
