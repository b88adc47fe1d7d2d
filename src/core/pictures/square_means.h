// A picture in means over squares of its pixels.
#pragma once

#include "core/image.h"

namespace livery {

/// Of R, G, B, coverage: colours of what covers a square, each pixel's by its coverage, and how
/// much of the square that is. Pixels beyond the last whole square are left out. A colour that is
/// no number makes its square's none. Throws std::invalid_argument for other channels or no side.
ImageF square_means(const ImageF& picture, int side_px);

}  // namespace livery
