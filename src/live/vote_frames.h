// The frames between looks under vote: what a projector sends for a mock-up that is neutral.
#pragma once

#include "core/image.h"
#include "live/projector_setup.h"

namespace livery {

/// The mean of what is wanted, as luminance (1: design white), over the pixels that are covered by
/// half or more. `wanted_working`: R, G, B, coverage. 0 where nothing is covered.
double mean_luminance(const ImageF& wanted_working);

/// Projector input for D65 grey of this luminance where `wanted_working` is covered, dark
/// elsewhere; what cannot be shown is clipped as for any look.
Image8 neutral_drive(const ImageF& wanted_working, double luminance, const ProjectorSetup& setup);

}  // namespace livery
