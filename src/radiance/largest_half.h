// What pictures of half floats may hold.
#pragma once

namespace livery {

/// A little below the largest half float, 65504: sums that round up stay finite.
inline constexpr float kLargestHalf = 65000.0f;

}  // namespace livery
