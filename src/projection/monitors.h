// The monitors there are, and what about them would ruin a projection.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <glm/vec2.hpp>

#include "core/image.h"

namespace livery {

/// One monitor or projector as the window system has it now. Coordinates are of the desktop.
struct Monitor {
    std::string id;    ///< the same after unplugging and plugging in again: output and its EDID
    std::string name;  ///< "HDMI-1, Epson EH-TW5650", for people
    int number = 0;    ///< 1, 2, ...: the number that show_numbers() shows on it
    int x = 0, y = 0, width = 0, height = 0;
    double refresh_hz = 60.0;
    bool primary = false;
};

/// Main thread. Ordered by position: left to right, then top to bottom.
std::vector<Monitor> list_monitors();
std::optional<Monitor> find_monitor(const std::vector<Monitor>& monitors, const std::string& id);

/// Something that changes the projector's picture behind our back.
struct SignalWarning {
    enum class Kind { gamma_ramp, night_light, limited_range, scaled };
    Kind kind = Kind::gamma_ramp;
    std::string what, cause, fix;  ///< each a sentence for the operator
};

/// Gamma ramp not identity, night light on, limited-range signal (where the driver tells), not the
/// native resolution, scaled, or not the calibration's size (0, 0: no calibration). Main thread.
std::vector<SignalWarning> check_signal(const Monitor& monitor, glm::ivec2 calibrated_px);

/// The picture by which people see a limited-range signal, which no driver need tell: steps near
/// black and near white that merge when levels are cut, and a line around it that overscan cuts
/// off. 3 channels, device values; at least 64x64.
Image8 signal_test_picture(int width, int height);

}  // namespace livery
