// The frames between looks under vote: what a projector sends for a mock-up that is neutral.
#pragma once

#include <optional>

#include "compensation/lit_pixels.h"
#include "core/image.h"
#include "live/projector_setup.h"

namespace livery {

/// The mean of what is wanted, as luminance (1: design white), over the pixels that are covered by
/// half or more. `wanted_working`: R, G, B, coverage. 0 where nothing is covered.
double mean_luminance(const ImageF& wanted_working);

/// Projector input for D65 grey of this luminance where `wanted_working` is covered, dark
/// elsewhere; what cannot be shown is clipped as for any look.
Image8 neutral_drive(const ImageF& wanted_working, double luminance, const ProjectorSetup& setup);

/// How much of a look is shown as it is wanted; nothing without a calibration, and where no pixel
/// of it has a correction.
std::optional<PictureReach> reach_of(const ImageF& wanted_working,
                                     const Image8& drive,
                                     const ProjectorSetup& setup);

}  // namespace livery
