// How far apart two pictures look.
#pragma once

#include <vector>

#include "core/image.h"

namespace livery {

/// CIEDE2000 at every pixel that both cover by half or more, in their order; what is no number is
/// infinitely far off. Both have R, G, B in the working space, 1 = white, and coverage. Throws
/// std::invalid_argument for others.
std::vector<float> colour_differences(const ImageF& one_working, const ImageF& other_working);

}  // namespace livery
