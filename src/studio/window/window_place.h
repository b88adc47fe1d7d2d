// Where the operator's window stands: as it stood, but never on the projector; and where GLFW has
// it and the monitors.
#pragma once

#include <glm/vec2.hpp>

#include "projection/monitors.h"
#include "studio/studio.h"

struct GLFWwindow;

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

/// x, y, width and height of each: GLFW tells of monitors that come and go, not of those that move.
std::vector<std::array<int, 4>> places_of_monitors();
/// Of the monitor that the window lies on.
float screen_scale(GLFWwindow* window, const std::vector<Monitor>& monitors);

WindowPlace place_of(GLFWwindow* window);
void put_window(GLFWwindow* window, const WindowPlace& place);
/// Where the window was left, or in the middle of the main monitor.
WindowPlace first_place(const Studio& studio, std::optional<glm::ivec2> size_px);
/// Off the projector, when the projector was chosen or monitors came and went.
void move_off_projector(Studio& studio, GLFWwindow* window);

/// Read on the background thread: the module that reads pictures takes a while to load. The window
/// must outlive the thread.
void give_icon(Studio& studio, GLFWwindow* window);

}  // namespace livery
