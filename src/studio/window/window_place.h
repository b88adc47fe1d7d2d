// Where the operator's window stands: as it stood, but never on the projector.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <glm/vec2.hpp>

#include "projection/monitors.h"

namespace livery {

/// Of the desktop, without the window manager's frame.
struct WindowPlace {
    glm::ivec2 position{0}, size_px{1280, 800};
    bool maximised = false;
    bool operator==(const WindowPlace&) const = default;
};

std::string text_of(const WindowPlace& place);
std::optional<WindowPlace> parse_window_place(const std::string& text);

/// The monitors' scale: what the system says; where it says nothing of a very fine screen, 2.
double default_scale(float content_scale, glm::ivec2 monitor_px);

/// The least in which everything can be read and nothing is cut off, at scale 1.
inline constexpr glm::ivec2 kLeastSize_px{1080, 600};

/// Whether a window there covers something of the projector, or lies where no other monitor is.
bool must_move(const WindowPlace& place,
               const std::vector<Monitor>& monitors,
               const std::string& projector_id);

/// Moves and shrinks `wanted` so that it lies on one monitor that is not the projector: the one
/// that it overlaps most, else the main one. Nothing when there is no other monitor.
std::optional<WindowPlace> place_beside_projector(const WindowPlace& wanted,
                                                  const std::vector<Monitor>& monitors,
                                                  const std::string& projector_id);

}  // namespace livery
