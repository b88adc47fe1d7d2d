// Answers of Mutter's, as its GetCurrentState sends them.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "projection/mutter.h"
#include "projection/session_bus.h"

namespace livery {

struct SaidMode {
    int width = 0, height = 0;
    bool current = true, preferred = true;
};

struct SaidMonitor {
    std::string connector, maker, product, serial;
    std::vector<SaidMode> modes;
    std::optional<std::uint32_t> colour_mode = {};
};

struct SaidLogicalMonitor {
    int x = 0, y = 0;
    double scale = 1.0;
    std::uint32_t transform = 0;
    std::vector<std::string> connectors;
};

struct SaidState {
    std::vector<SaidMonitor> monitors;
    std::vector<SaidLogicalMonitor> logical_monitors;
    std::optional<std::uint32_t> layout_mode = 1;  ///< logical
};

/// A laptop's screen, and a projector of 1920x1080 right of it.
SaidState said_of_two(double projector_scale = 1.0, std::uint32_t projector_transform = 0);

/// A method's return with this.
BusMessage mutter_message(const SaidState& state);
/// The same as the program reads it.
MutterState mutter_state(const SaidState& state);

}  // namespace livery
