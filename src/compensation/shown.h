// What a projector input shows, by the calibration that it was corrected with.
#pragma once

#include "compensation/compensation.h"
#include "core/image.h"

namespace livery {

/// The inverse of compensate(): R, G, B in the working space (1: design white), then 1 where the
/// table has a pixel and 0 elsewhere. It knows the projector as the calibration does, levels of 8
/// bits, clipping and gamut mapping included; what the calibration itself is wrong about it cannot
/// know. Throws std::invalid_argument on a wrong size or channel count.
ImageF shown_by(const CompensationTable& table, const Image8& drive);
/// The same of drives between whole levels, 0 to 255 (exact_drive()).
ImageF shown_by(const CompensationTable& table, const ImageF& drive);

/// How much of a wanted picture is shown as it is wanted, by shown_by().
struct PictureReach {
    std::size_t pixels = 0;           ///< covered by half or more, with a correction
    double reachable_fraction = 0.0;  ///< of these, CIEDE2000 under kAsWanted
    double de00_median = 0.0, de00_p95 = 0.0;
};
/// One level of 8 bits is up to 1 in the dark; 2 is seen by few even side by side.
inline constexpr double kAsWanted = 2.0;

/// `wanted_working`: R, G, B, coverage. None of its pixels has a correction: all 0.
PictureReach reach_of(const CompensationTable& table,
                      const ImageF& wanted_working,
                      const Image8& drive);

}  // namespace livery
