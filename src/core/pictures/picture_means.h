// How far apart two pictures look, and pictures by means of squares of pixels.
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

/// Of R, G, B, coverage: colours of what covers a square, each pixel's by its coverage, and how
/// much of the square that is. Pixels beyond the last whole square are left out. A colour that is
/// no number makes its square's none. Throws std::invalid_argument for other channels or no side.
ImageF square_means(const ImageF& picture, int side_px);

}  // namespace livery
