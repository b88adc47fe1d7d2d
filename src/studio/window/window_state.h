// What of the window is remembered in the session's workspace, and told in the `--ui-map`.
#pragma once

#include <string>

#include "studio/kit/ui_map.h"

namespace livery {

struct Studio;

inline constexpr const char* kWindowKey = "window";

void restore_workspace(Studio& studio);
/// Writes what differs from what is remembered; sizes and places only when they rest for a moment,
/// or `now`.
void remember_workspace(Studio& studio, const std::string& window_place, bool now);

MapState state_of_window(const Studio& studio);

/// Once a frame of the window: while something could not be saved, tries again every two seconds,
/// and tells both.
void save_again_now_and_then(Studio& studio);
/// Says loudly when nothing is being saved.
void tell_unsaved(Studio& studio);

}  // namespace livery
