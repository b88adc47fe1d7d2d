// What the window does once a frame, what it remembers in the session's workspace and tells in the
// `--ui-map`.
#pragma once

#include <string>

#include "studio/kit/input_queue.h"
#include "studio/kit/ui_map.h"

namespace livery {

struct Studio;

void draw_layout(Studio& studio);
void draw_notices(Studio& studio);
void draw_projector_bar(Studio& studio);
void draw_status_line(Studio& studio);

/// Runs what a key means; what means nothing Dear ImGui gets. Hears of focus too.
EventUse handle_key(Studio& studio, const InputEvent& event);

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
