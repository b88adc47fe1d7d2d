// Gray code photographs -> where each projector pixel is seen by the camera.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/bench_ports.h"
#include "core/image.h"
#include "core/progress.h"

namespace livery {

/// A photograph with the role of the pattern that it shows.
struct RoledPhotograph {
    std::string role;
    Photograph photograph;
};

struct GrayCodeResult {
    ImageF projector_px;  ///< camera pixels -> projector pixel (2 channels, centres at halves), NaN
    Image8 decoded;       ///< 255 where decoded
    double lit_fraction = 0.0;      ///< of the camera picture
    double decoded_fraction = 0.0;  ///< of the lit pixels
};

/// Decodes by the sign of each bit pair. `lit_threshold` is white - black in file units; negative
/// picks it from the noise. Throws Refused when too little decodes, std::invalid_argument or
/// FileError for missing roles and unequal sizes.
GrayCodeResult decode_gray_code(const std::vector<RoledPhotograph>& photographs,
                                int projector_width,
                                int projector_height,
                                double lit_threshold = -1.0);

/// Projector pixels -> sub-pixel camera pixel (2 channels, centres at halves), NaN where unknown;
/// local fits that do not reach across depth or part edges. `edge` is 255 where the pixel's
/// neighbourhood breaks.
struct ProjectorToCamera {
    ImageF camera_px;
    Image8 edge;
};
ProjectorToCamera invert_map(const GrayCodeResult& decoded, int projector_width, int projector_height);

}  // namespace livery
