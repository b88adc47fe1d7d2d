// What Mutter, GNOME's compositor, says of its monitors: the answer of
// org.gnome.Mutter.DisplayConfig.GetCurrentState as values.
#pragma once

#include <string>
#include <vector>

#include <glm/vec2.hpp>

#include "projection/display_identity.h"

struct DBusMessage;

namespace livery {

struct MutterMonitor {
    std::string connector;       ///< "HDMI-1"
    DisplayIdentity identity;    ///< empty where the monitor has no EDID
    glm::ivec2 mode_px{0};       ///< what goes down the cable; 0: off, or not told
    glm::ivec2 preferred_px{0};  ///< what the monitor asks for; 0: not told
    unsigned colour_mode = 0;    ///< 0: as ever; 1: high dynamic range
    double refresh_hz = 0.0;     ///< of the mode; 0: not told
    bool operator==(const MutterMonitor&) const = default;
};

/// A part of the desktop, and the monitors that show it: several mirror one another.
struct MutterLogicalMonitor {
    int x = 0, y = 0;
    double scale = 1.0;
    int transform = 0;  ///< quarter turns, 4 more where it is mirrored
    std::vector<std::string> connectors;
    bool operator==(const MutterLogicalMonitor&) const = default;
};

struct MutterState {
    std::vector<MutterMonitor> monitors;
    std::vector<MutterLogicalMonitor> logical_monitors;
    /// The desktop is laid out in pixels of the monitors; else in those divided by the scale.
    bool physical_layout = false;
    bool operator==(const MutterState&) const = default;

    const MutterMonitor* find(const std::string& connector) const;  ///< null: none
};

/// Throws std::runtime_error with what was found and what was expected.
MutterState read_mutter_state(DBusMessage& answer);

}  // namespace livery
