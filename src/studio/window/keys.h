// What a key does in the window, wherever the keyboard is.
#pragma once

#include "studio/window/input_queue.h"

namespace livery {

struct Shell;

/// Runs what a key means; what means nothing Dear ImGui gets. Hears of focus too.
EventUse handle_key(Shell& shell, const InputEvent& event);

}  // namespace livery
