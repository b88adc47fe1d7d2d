// What a designer waits for, measured without a window: from a paint swap to the finished frame,
// alone and beside everything that the desktop does in the background; and from a step of an eye or
// a light that is dragged.
#pragma once

#include <vector>

#include "core/progress.h"
#include "gl/context.h"
#include "ledger/level.h"

namespace livery {

std::vector<LedgerEffect> measure_desktop(GlDevice device, const Progress& progress = {});

}  // namespace livery
