// The paint library as the panels see it: read again when the user's folder changes.
#pragma once

#include "studio/studio.h"

namespace livery {

/// When it cannot be read, studio.panels.library.problem says why, and the last good one stays.
const PaintLibrary& current_library(Studio& studio);

}  // namespace livery
