// Fewer triangles where nobody looks.
#pragma once

#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

namespace livery::assets {

struct CoarseTriangle {
    glm::uvec3 corners{0};
    std::uint32_t origin = 0;  ///< index of the triangle that it was
};

/// Collapses edges onto one of their ends while the surface stays within each vertex's tolerance of
/// where it was and turns by less than 25 degrees. Vertices without tolerance, as those of its
/// border must be, stay with all edges between them. Returns the triangles that are left; the
/// vertices keep their indices.
std::vector<CoarseTriangle> coarsened(const std::vector<glm::dvec3>& points_mm,
                                      std::vector<glm::uvec3> triangles,
                                      const std::vector<double>& tolerance_mm);

}  // namespace livery::assets
