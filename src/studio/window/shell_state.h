// What of the window is remembered in the session's workspace, and told in the `--ui-map`.
#pragma once

#include <string>

#include "studio/kit/ui_map.h"

namespace livery {

struct Shell;

inline constexpr const char* kWindowKey = "window";
inline constexpr const char* kMonitorKey = "projector-monitor";

void restore_workspace(Shell& shell);
/// Writes what differs from what is remembered; sizes and places only when they rest for a moment,
/// or `now`.
void remember_workspace(Shell& shell, const std::string& window_place, bool now);

MapState state_of_shell(const Shell& shell);

/// The ballots' database beside the session's; a notice when it cannot be opened.
void open_ballots(Shell& shell);
/// Once a frame of the window: while something could not be saved, tries again every two seconds,
/// and tells both.
void save_again_now_and_then(Shell& shell);
/// Says loudly when nothing is being saved.
void tell_unsaved(Shell& shell);

}  // namespace livery
