// Parts of check_signal() that need no server.
#pragma once

#include <vector>

#include <glm/vec2.hpp>

#include "projection/desktop_watch.h"
#include "projection/monitors.h"
#include "projection/outputs.h"

namespace livery {

/// The beginning of what to do in GNOME's settings.
inline constexpr const char* kInDisplaySettings =
    "In GNOME's Settings, Displays (`gnome-control-center display`), choose this display and ";

/// Whether a pixel of the desktop is another one than a pixel of the monitor's, as far as is known.
bool is_scaled(const Output& output);

std::vector<SignalWarning> warnings_of_size(const Output& output, glm::ivec2 calibrated_px);

/// Of an output of Xwayland: a scale or a turn, the night light, and what nobody can know there.
std::vector<SignalWarning> warnings_behind_wayland(const Output& output,
                                                   const DesktopState& desktop);

}  // namespace livery
