// A degree in radians.
#pragma once

#include <numbers>

namespace livery::testing {

inline constexpr double kDegree = std::numbers::pi / 180.0;

}  // namespace livery::testing
