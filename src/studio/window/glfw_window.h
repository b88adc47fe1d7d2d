// The operator's window and the monitors as GLFW has them.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "studio/studio.h"
#include "studio/window/window_place.h"

struct GLFWwindow;

namespace livery {

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
