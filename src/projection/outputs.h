// RandR's outputs that show something, as values.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <glm/vec2.hpp>

#include "projection/monitors.h"
#include "projection/x_connection.h"

namespace livery {

struct Output {
    Monitor monitor;
    std::string socket;                  ///< "HDMI-1"
    std::uint32_t output = 0, crtc = 0;  ///< RandR's
    glm::ivec2 preferred_px{0};          ///< what the monitor asks for; 0: nobody tells
    bool turned = false;                 ///< by a quarter
    bool transformed = false;            ///< scaled or warped by the server
    bool behind_wayland = false;         ///< Xwayland's: a compositor decides what is shown
};

/// Connected and lit, ordered and numbered by position: left to right, then top to bottom. What
/// the server knows, well under a millisecond; it looks at the hardware only where that cannot be.
/// Behind Xwayland `desktop` names them; null: the server alone is asked.
std::vector<Output> read_outputs(const XConnection& x, DesktopWatch* desktop);

/// A property of an output as bytes; empty where there is none.
std::vector<std::uint8_t> output_property(const XConnection& x,
                                          std::uint32_t output,
                                          std::string_view name);

/// Gives it the socket, the display's identity, and the id and the name that come of them.
void name_output(Output& output, const std::string& socket, const DisplayIdentity& identity);

bool overlap(const Monitor& a, const Monitor& b);

}  // namespace livery
