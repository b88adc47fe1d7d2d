// Fits that count every pair of directions.
#pragma once

#include "appearance/directions.h"

namespace livery {

inline bool everywhere(const DirectionPair&) { return true; }

}  // namespace livery
