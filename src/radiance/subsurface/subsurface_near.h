// Light that leaves a translucent part a few millimetres beside where it entered: nearer than nodes
// are to one another, gathered from fragment to fragment.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "radiance/glints.h"
#include "radiance/subsurface/subsurface_kernel.h"
#include "radiance/surface_map.h"

namespace livery {

/// Of what enters at each fragment of a part, the mean over those around weighed by the kernel's
/// near part, and over the fragment; 0 at fragments of other parts. `entering` is of the part's
/// alone, in their order.
std::vector<glm::vec3> entering_nearby(const SurfaceMap& map,
                                       const PixelSize& pixels,
                                       std::size_t part,
                                       const SubsurfaceKernel& kernel,
                                       std::span<const glm::vec3> entering);

}  // namespace livery
