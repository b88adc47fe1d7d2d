// What compensate() does with the instruction set said, so that tests can compare them.
#pragma once

#include "compensation/compensation.h"
#include "compensation/kernel.h"

namespace livery {

void compensate_with(const kernel::Functions& functions,
                     const CompensationTable& table,
                     const ImageF& wanted_working,
                     std::size_t covered_pixels,
                     Image8* drive,
                     CompensationStats* stats);

/// Of pixels that were counted, `covered_pixels` of the picture's.
CompensationStats stats_of(const kernel::Counts& counts, std::size_t covered_pixels);

/// Wanted colours as compensate() moves them before it corrects: into what each pixel can show if
/// the table was baked so, else as they are. What is not valid, not covered or not finite passes
/// through.
ImageF map_gamut(const kernel::Functions& functions,
                 const CompensationTable& table,
                 const ImageF& wanted_working);

/// The drives, 0 to 255, before dither and the cut to whole levels: three channels, black where
/// compensate() is. Throws as compensate().
ImageF exact_drive(const CompensationTable& table, const ImageF& wanted_working);

}  // namespace livery
