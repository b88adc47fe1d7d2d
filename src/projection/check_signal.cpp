#include "projection/check_signal.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numeric>
#include <span>

#include <fmt/format.h>
#include <xcb/randr.h>

#include "projection/session_bus.h"
#include "projection/x_connection.h"

namespace livery {
namespace {

using Kind = SignalWarning::Kind;

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

/// The desktop that says that its night light is on now.
std::optional<std::string> night_light_of_desktop() {
    struct NightLight {
        const char* desktop;
        SessionBus::Object object;
        const char* property;
    };
    constexpr NightLight kKnown[] = {
        {"GNOME",
         {"org.gnome.SettingsDaemon.Color",
          "/org/gnome/SettingsDaemon/Color",
          "org.gnome.SettingsDaemon.Color"},
         "NightLightActive"},
        {"KDE Plasma",
         {"org.kde.KWin", "/org/kde/KWin/NightLight", "org.kde.KWin.NightLight"},
         "running"},
        {"KDE Plasma", {"org.kde.KWin", "/ColorCorrect", "org.kde.kwin.ColorCorrect"}, "running"},
    };
    const auto bus = SessionBus::connect();
    if (!bus) return std::nullopt;
    for (const auto& known : kKnown) {
        if (bus->read_bool(known.object, known.property).value_or(false)) return known.desktop;
    }
    return std::nullopt;
}

void check_colours(const XConnection& x, const Output& output, std::vector<SignalWarning>& list) {
    const auto ramp = read_ramp(x, output.crtc);
    const bool changed =
        ramp && !(is_identity(ramp->red) && is_identity(ramp->green) && is_identity(ramp->blue));
    const auto desktop = night_light_of_desktop();
    const std::string reset =
        fmt::format("run `xrandr --output {} --gamma 1:1:1 --brightness 1`.", output.socket);
    if (desktop || (changed && is_warm(*ramp))) {
        const std::string table =
            changed ? fmt::format("The graphics card leaves {:.0f}% of the blue on {}",
                                  100.0 * mean(ramp->blue) / mean(ramp->red),
                                  output.socket)
                    : std::string();
        list.push_back({Kind::night_light,
                        "A night light tints the projector's picture.",
                        desktop ? *desktop + " says that its night light is on" +
                                      (changed ? "; t" + table.substr(1) : "") + "."
                                : table + ", as a night light does.",
                        "Switch the night light off in the display settings" +
                            (desktop ? std::string(".") : ", or " + reset)});
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

}  // namespace

std::vector<SignalWarning> warnings_of_size(const Output& output, glm::ivec2 calibrated_px) {
    std::vector<SignalWarning> list;
    const glm::ivec2 shown_px(output.monitor.width, output.monitor.height);
    const glm::ivec2 best_px = output.preferred_px;
    if (best_px.x > 0 && best_px != output.mode_px) {
        list.push_back({Kind::scaled,
                        "The projector does not get its own resolution and scales the picture.",
                        fmt::format("{} is set to {}, and the projector asks for {}.",
                                    output.socket,
                                    size_text(output.mode_px),
                                    size_text(best_px)),
                        fmt::format("Choose {} in the display settings, or run `xrandr --output {} "
                                    "--mode {}`.",
                                    size_text(best_px),
                                    output.socket,
                                    size_text(best_px))});
    }
    const glm::ivec2 upright_px = output.turned ? glm::ivec2(shown_px.y, shown_px.x) : shown_px;
    if (output.transformed || upright_px != output.mode_px) {
        list.push_back({Kind::scaled,
                        "The desktop scales the picture on its way to the projector.",
                        fmt::format("{} shows {} of the desktop with {} pixels.",
                                    output.socket,
                                    size_text(shown_px),
                                    size_text(output.mode_px)),
                        fmt::format("Set the scale of this display to 100%, or run `xrandr "
                                    "--output {} --scale 1x1`.",
                                    output.socket)});
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

std::vector<SignalWarning> check_signal(const Monitor& monitor, glm::ivec2 calibrated_px) {
    const XConnection x;
    std::vector<SignalWarning> list;
    for (const auto& output : read_outputs(x)) {
        if (output.monitor.id != monitor.id) continue;
        check_colours(x, output, list);
        check_range(x, output, list);
        const auto sizes = warnings_of_size(output, calibrated_px);
        list.insert(list.end(), sizes.begin(), sizes.end());
    }
    return list;
}

}  // namespace livery
