// The photograph of the grey levels: the light scattered onto its black blocks, and whether it
// shows what the other five say it must.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "calibration/colour/colour_samples.h"
#include "calibration/colour/mixing.h"
#include "calibration/colour/response.h"
#include "calibration/correspondence/patterns.h"

namespace livery {

struct ScatteredLight {
    std::vector<glm::vec3> separated;  ///< one a sample, in the units of PixelMixing::span
    std::vector<glm::vec3> variance;   ///< of it: how black blocks around there differ
    glm::dvec3 of_span{0.0};           ///< its mean over the black blocks, relative to their span
};

/// The grey levels' photograph with what is needed to read it.
struct LevelsSamples {
    const ColourSamples& samples;
    const PixelMixing& mixing;
    const std::vector<std::uint8_t>& usable;  ///< one a sample
    const Pattern& levels;
    const std::vector<std::uint8_t>& centre;  ///< of the pattern's blocks; one a projector pixel
};

/// The levels' photograph minus black (drive 0: the dark picture's) on black blocks, averaged
/// around each sample: over many blocks where it changes slowly, as flare does, over the few next
/// to it where they differ by more than noise, as light between parts does. A place far from all of
/// them gets the mean of all.
ScatteredLight scattered_light(const LevelsSamples& seen);

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
