// What goes wrong while photographs are taken, told from the photographs alone and by name: before
// anything is solved from them, so that no later stage blames the projector for it.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "calibration/captures/capture_summary.h"

namespace livery {

struct ShownDrives {
    int dark = 0, bright = 255;  ///< s and t of dark-gray and bright-gray
};

/// A steady change of the lamp's light, read from the stripes, white and black.
struct LampDrift {
    double slope = 0.0;   ///< relative change a photograph; 0: none that stands out of the scatter
    double centre = 0.0;  ///< where the light is 1, in photographs
    double light_at(double taken_at) const { return 1.0 + slope * (taken_at - centre); }
};

struct CaptureVerdict {
    std::vector<std::string> warnings;
    LampDrift drift;  ///< to be taken out of the photographs
    /// By role: what the light of a photograph with a small slip of its exposure must be multiplied
    /// by so that it fits the others.
    std::map<std::string, double> gains;
};

/// `captures` in the order in which they were taken, of one size: all of a calibration, or the
/// first of them. Throws Refused for what spoils a calibration: over-exposure, automatic exposure,
/// pictures that arrive late, a camera that moved, shadows, light that changed, single exposures
/// that differ, swapped roles, files that are not linear. Warns of what only makes it worse.
CaptureVerdict check_captures(const std::vector<CaptureSummary>& captures,
                              int block_px,
                              const ShownDrives& drives);

}  // namespace livery
