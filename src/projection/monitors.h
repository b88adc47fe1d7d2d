// The monitors there are, what each says of itself, and what about them would ruin a projection.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <glm/vec2.hpp>

#include "core/image.h"

namespace livery {

/// In the words of Mutter, GNOME's compositor, which reads the same EDID: X11 and Wayland then
/// agree on a display. All empty where there is no EDID.
struct DisplayIdentity {
    std::string maker;    ///< three letters: "EPS"
    std::string product;  ///< "EPSON PJ", or its code as "0x1a2b"
    std::string serial;   ///< "X4KF123", or its number as "0x00000001"
    bool operator==(const DisplayIdentity&) const = default;
};

/// Empty for less than a whole block.
DisplayIdentity identity_of_edid(const std::vector<std::uint8_t>& edid);

/// "EPSON PJ", else the maker's letters; empty for neither.
std::string display_name(const DisplayIdentity& identity);

/// What a monitor is remembered by: "HDMI-1:0123456789abcdef", or the socket alone where the
/// display says nothing.
std::string monitor_id(const std::string& socket, const DisplayIdentity& identity);

/// As version 0.1 wrote it: by every byte of the EDID.
std::string former_monitor_id(const std::string& socket, const std::vector<std::uint8_t>& edid);

/// Whether the serial number tells the display from others of its kind: makers who do not count
/// write 0 or 0x01010101.
bool has_serial(const DisplayIdentity& identity);

/// How a Wayland compositor shows its part of the desktop on a monitor.
struct WaylandOutput {
    double scale = 1.0;
    int transform = 0;         ///< quarter turns, 4 more where it is mirrored
    unsigned colour_mode = 0;  ///< Mutter's; 0: as ever; 1: high dynamic range
};

/// One monitor or projector as the window system has it now. Coordinates are of the desktop.
struct Monitor {
    std::string id;              ///< the same after unplugging and plugging in again: monitor_id()
    std::string name;            ///< "HDMI-1, Epson EH-TW5650", for people
    std::string former_id = {};  ///< as version 0.1 remembered it; empty: it had none
    DisplayIdentity identity = {};
    int number = 0;  ///< 1, 2, ...: the number that show_numbers() shows on it
    int x = 0, y = 0, width = 0, height = 0;
    glm::ivec2 mode_px{0};  ///< what goes down the cable; 0: nobody tells
    double refresh_hz = 60.0;
    bool primary = false;
    std::optional<WaylandOutput> wayland = {};  ///< none: it is Xorg's, or nobody tells
};

class DesktopWatch;

/// Whether the X server at DISPLAY is a Wayland compositor's; false where there is none.
bool is_xwayland();

/// Ordered by position: left to right, then top to bottom. Behind Xwayland `desktop` names them;
/// null: X alone is asked. Throws std::runtime_error without X.
std::vector<Monitor> list_monitors(DesktopWatch* desktop = nullptr);
std::optional<Monitor> find_monitor(const std::vector<Monitor>& monitors, const std::string& id);
/// One that an earlier start remembered: also by what version 0.1 remembered, and in another socket
/// where its serial number tells it from all others (X11 and Wayland name sockets differently).
std::optional<Monitor> find_remembered_monitor(const std::vector<Monitor>& monitors,
                                               const std::string& id);

/// Something that changes the projector's picture behind our back, or may.
struct SignalWarning {
    enum class Kind {
        gamma_ramp,
        night_light,
        limited_range,
        scaled,
        turned,
        colour_mode,
        colours_unknown,
        scale_unknown
    };
    /// A note says what nobody can know; an error spoils every picture.
    enum class Severity { note, warning, error };
    Kind kind = Kind::gamma_ramp;
    std::string what, cause, fix;  ///< each a sentence for the operator
    Severity severity = Severity::warning;
};

const char* name_of(SignalWarning::Severity severity);  ///< "note", "warning", "error"

/// Gamma ramp not identity, night light on, limited-range signal (where the driver tells), not the
/// native resolution, scaled or turned by the desktop, or not the calibration's size (0, 0: no
/// calibration). Behind Xwayland also what cannot be known there. The worst comes first.
std::vector<SignalWarning> check_signal(const Monitor& monitor,
                                        glm::ivec2 calibrated_px,
                                        DesktopWatch& desktop);

/// The picture by which people see a limited-range signal, which no driver need tell: steps near
/// black and near white that merge when levels are cut, and a line around it that overscan cuts
/// off. 3 channels, device values; at least 64x64.
Image8 signal_test_picture(int width, int height);

}  // namespace livery
