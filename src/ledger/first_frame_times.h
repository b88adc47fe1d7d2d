// What somebody waits for who opens the program: from the product's file to the first complete
// corrected picture.
#pragma once

#include "core/progress.h"
#include "ledger/level.h"

namespace livery {

/// Effect "load to first frame", in the current OpenGL context: of the shipped car under the first
/// shipped look, each time from nothing, with the calibration at hand; and what its parts take.
LedgerEffect measure_first_frame(const Progress& progress = {});

}  // namespace livery
