// Fragments shaded by what shades a picture's (radiance/shading.h), number by number: what a frame
// would show of them, before half floats and before pixels are mixed.
#pragma once

#include <vector>

#include <glm/vec3.hpp>

#include "radiance/lanes/lane_shading.h"
#include "radiance/lanes/shading_in_double.h"

namespace livery {

/// By the lanes of the processor, as a frame runs them.
std::vector<glm::vec3> shaded_in_lanes(const Material& material,
                                       const LooseFragments& fragments,
                                       double exposure_ev,
                                       const LaneFunctions& functions = best_lanes());

/// By the shader, in the current OpenGL context, into 32-bit floats.
std::vector<glm::vec3> shaded_in_gl(const Material& material,
                                    const LooseFragments& fragments,
                                    double exposure_ev);

}  // namespace livery
