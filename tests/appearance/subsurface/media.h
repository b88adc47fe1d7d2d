// Media that were measured, and the books of photons.
#pragma once

#include "appearance/subsurface/monte_carlo.h"
#include "appearance/subsurface/scattering_medium.h"

namespace livery {

inline const ScatteringMedium kMarble{0.0041, 2.62, 0.0, 1.5, {}};
inline const ScatteringMedium kSkin{0.17, 0.88, 0.0, 1.3, {}};

/// 1 when no power is lost.
inline double sum_of(const MonteCarloProfile& profile) {
    return profile.total_reflectance.value + profile.total_transmittance.value +
           profile.absorbed.value + profile.unscattered_reflectance +
           profile.unscattered_transmittance;
}

}  // namespace livery
