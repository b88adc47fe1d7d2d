// How far apart two pictures look.
#pragma once

#include <vector>

#include "core/image.h"

namespace livery {

/// CIEDE2000 at every pixel, one channel; NaN where not both cover by half or more, and what is no
/// number infinitely far off. Both have R, G, B in the working space, 1 = white, and coverage.
/// Throws std::invalid_argument for others.
ImageF colour_difference_map(const ImageF& one_working, const ImageF& other_working);

/// The same of the pixels that both cover, in their order.
std::vector<float> colour_differences(const ImageF& one_working, const ImageF& other_working);

/// Those of a map.
std::vector<float> covered_differences(const ImageF& map);

}  // namespace livery
