// How far a rendered picture is from the truth, in the unit that the audience sees.
#pragma once

#include <cstddef>

#include "core/image.h"

namespace livery {

/// Of the largest channel difference of each pixel, over the pixels that both pictures cover by at
/// least half, in radiance (1: design white).
struct RadianceError {
    double median = 0.0, p90 = 0.0, p99 = 0.0, largest = 0.0;
    double mean_signed = 0.0;  ///< first minus second, mean over pixels and channels: a bias
    std::size_t pixels = 0;
};

/// Both as RadianceRenderer::read_back: R, G, B, coverage. Throws std::invalid_argument on
/// different sizes.
RadianceError radiance_error(const ImageF& rendered, const ImageF& truth);

}  // namespace livery
