// The bench's photographs for people to look at, without any calibration.
#pragma once

#include <glm/mat3x3.hpp>

#include "core/bench_ports.h"
#include "jobs/picture.h"
#include "mesh/mesh.h"
#include "twin/description.h"

namespace livery {

/// From linear camera colour a second to XYZ, exact for a neutral surface under the projector's
/// primaries; a white diffuser that faces full red + green + blue has Y = 1.
glm::dmat3 xyz_from_bench_camera(const BenchDescription& bench);

/// A photograph as sRGB where `white_y` is white; 0: its 99.9th percentile.
Image8 srgb_from_photograph(const Photograph& photograph,
                            const BenchDescription& bench,
                            const PixelRectangle& part,
                            double white_y);

}  // namespace livery
