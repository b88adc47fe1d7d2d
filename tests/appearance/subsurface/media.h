// Media that were measured.
#pragma once

#include "appearance/subsurface/scattering_medium.h"

namespace livery {

inline const ScatteringMedium kMarble{0.0041, 2.62, 0.0, 1.5, {}};
inline const ScatteringMedium kSkin{0.17, 0.88, 0.0, 1.3, {}};

}  // namespace livery
