// A small shaded picture of a mesh, drawn by the processor: enough to see which way is up.
#pragma once

#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>

#include "core/image.h"
#include "mesh/mesh.h"

namespace livery {

/// Three quarters: from between +z and +x of the world.
inline constexpr double kThreeQuarters_rad = 0.6;

/// Seen from that azimuth, from +z towards +x, and a little above without perspective, filling the
/// picture; the ground under it is shown. Open and turned-over surfaces are shaded from both sides.
/// sRGB, 4 channels, straight alpha: nothing there is transparent.
Image8 mesh_picture(const Mesh& mesh,
                    const glm::dmat3& world_from_mesh,
                    glm::ivec2 size_px,
                    double azimuth_rad = kThreeQuarters_rad);

}  // namespace livery
