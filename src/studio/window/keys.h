// What a key does in the window, wherever the keyboard is.
#pragma once

#include "studio/window/input_queue.h"

namespace livery {

struct Shell;

/// Runs what a key means; true when it meant something, and Dear ImGui does not get it. Hears of
/// focus too.
bool handle_key(Shell& shell, const InputEvent& event);

}  // namespace livery
