// What Mutter, GNOME's compositor, says of its monitors
// (org.gnome.Mutter.DisplayConfig.GetCurrentState), and which output of Xwayland each of them is.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include <glm/vec2.hpp>

#include "projection/monitors.h"
#include "projection/outputs.h"

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

/// Connectors by RandR's output, as found so far.
using KnownConnectors = std::map<std::uint32_t, std::string>;

/// Gives outputs of Xwayland the names, identities, modes, scales and transforms that Mutter tells.
/// Since version 23.1 Xwayland names an output after its connector. Else an output is found as it
/// was before (it is the same monitor's for as long as Xwayland has it, wherever that is moved), or
/// by its place and size, which must be one monitor's alone; `known` gains it. Mirrored monitors
/// have one place: until they are apart they are named in the order of both lists. What is not
/// found stays as it is, with no mode.
void name_outputs_after(const MutterState& state,
                        std::vector<Output>& outputs,
                        KnownConnectors& known);

}  // namespace livery
