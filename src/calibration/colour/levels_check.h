// Whether the photograph of the grey levels shows what the other five say it must.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "calibration/colour/response.h"
#include "calibration/colour/scattered_light.h"

namespace livery {

struct LevelsVerdict {
    std::vector<std::string> warnings;
    /// How far its white blocks lie from bright-gray, where neither scattered light nor an exposure
    /// of its own explains it.
    double unexplained = 0.0;
};

/// `curves`: N of each drive as fitted, one a channel. Throws Refused where the photograph does not
/// follow its pattern, or a part of it lies in a shadow.
LevelsVerdict check_levels(const LevelsSamples& seen,
                           const ScatteredLight& scattered,
                           const std::array<LevelCurve, 3>& curves);

}  // namespace livery
