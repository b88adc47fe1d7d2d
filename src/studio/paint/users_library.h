// The paint library as the panels see it: read again when the user's folder changes.
#pragma once

#include "studio/studio.h"

namespace livery {

/// When it cannot be read, studio.panels.library.problem says why, and the last good one stays.
/// A measured paint of the user's is not in it before its file was read on the background thread.
const PaintLibrary& current_library(Studio& studio);

/// Reads a measured file on the background thread, unless that is under way, and then the library.
void read_measured_behind(Studio& studio, const std::filesystem::path& file);

}  // namespace livery
