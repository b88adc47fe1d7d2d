// Angles are in radians; people read degrees.
#pragma once

#include <numbers>

namespace livery {

inline constexpr double kDegreesPerRadian = 180.0 / std::numbers::pi;
inline constexpr double kFullTurn = 2.0 * std::numbers::pi;

}  // namespace livery
