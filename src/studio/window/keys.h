// What a key does in the window, wherever the keyboard is.
#pragma once

#include "studio/kit/input_queue.h"

namespace livery {

struct Studio;

/// Runs what a key means; what means nothing Dear ImGui gets. Hears of focus too.
EventUse handle_key(Studio& studio, const InputEvent& event);

}  // namespace livery
