// LIVERY_THOROUGH=1 runs what is left out of sweeps so that all tests end within half an hour: more
// paints, more wrong data sheets, a second product.
#pragma once

#include <cstdlib>

namespace livery {

inline bool thorough() { return std::getenv("LIVERY_THOROUGH") != nullptr; }

}  // namespace livery
