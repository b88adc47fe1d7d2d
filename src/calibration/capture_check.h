// What goes wrong while photographs are taken, told from the photographs alone and by name: before
// anything is solved from them, so that no later stage blames the projector for it.
#pragma once

#include <string>
#include <vector>

#include "calibration/capture_summary.h"

namespace livery {

struct ShownDrives {
    int dark = 0, bright = 255;  ///< s and t of dark-gray and bright-gray
};

/// `captures` in the order in which they were taken, of one size. Throws Refused for what spoils a
/// calibration: over-exposure, automatic exposure, pictures that arrive late, a camera that moved,
/// shadows, light that changed, single exposures that differ, swapped roles, files that are not
/// linear. Returns warnings for what only makes it worse.
std::vector<std::string> check_captures(const std::vector<CaptureSummary>& captures,
                                        int block_px,
                                        const ShownDrives& drives);

}  // namespace livery
