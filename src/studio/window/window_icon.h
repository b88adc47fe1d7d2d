// The icon of the operator's window, for task bars that do not go by the desktop entry.
#pragma once

struct GLFWwindow;

namespace livery {

struct Studio;

/// Read on the background thread: the module that reads pictures takes a while to load. The window
/// must outlive the thread.
void give_icon(Studio& studio, GLFWwindow* window);

}  // namespace livery
