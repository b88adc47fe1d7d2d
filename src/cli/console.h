// What a command shows while it works: progress on stderr, and Ctrl-C.
#pragma once

#include "core/progress.h"

namespace livery {

/// From now on Ctrl-C asks the running work to stop; a second one ends the program at once.
/// The Progress draws a bar on a terminal and prints lines otherwise; nothing in the first two
/// seconds, so that quick commands stay silent.
Progress console_progress();

/// Removes a half-drawn bar before other text is printed.
void finish_progress_line();

}  // namespace livery
