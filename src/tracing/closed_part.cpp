#include "tracing/closed_part.h"

#include <algorithm>

#include "mesh/surface.h"

namespace livery {

bool is_closed(const Mesh& mesh, std::size_t part) {
    Surface surface;
    const std::vector<std::uint32_t> point_of = weld(mesh.positions_mm, surface.points);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        if (mesh.triangle_part[t] != part) continue;
        const glm::uvec3 c = mesh.triangles[t];
        const glm::uvec3 welded(point_of[c.x], point_of[c.y], point_of[c.z]);
        // A triangle of two points has no side to hang on
        if (welded.x == welded.y || welded.y == welded.z || welded.z == welded.x) continue;
        surface.triangles.push_back(welded);
    }
    find_neighbours(surface);
    return !surface.triangles.empty() &&
           std::none_of(surface.lone.begin(), surface.lone.end(), [](bool lone) { return lone; });
}

}  // namespace livery
