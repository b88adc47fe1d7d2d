// What the models of media and of layers share on their way to a profile.
#pragma once

#include <functional>

#include "appearance/subsurface/diffusion.h"
#include "appearance/subsurface/subsurface_profile.h"

namespace livery {

/// A profile and its totals, of which each model makes its own.
struct MadeProfile {
    std::function<Exitance(double radius_mm)> at;
    Exitance totals;
};

/// What `multiple` is to be multiplied with to add up to the exact totals beside single scattering.
Exitance factors_to(const DiffuseTotals& exact,
                    const DiffuseTotals& once,
                    const MadeProfile& multiple);

/// Fills in totals, scale and both sides: nothing below 0, no more than what scatters.
void finish_profile(const MadeProfile& made,
                    const UnscatteredLight& unscattered,
                    SubsurfaceProfile& profile);

}  // namespace livery
