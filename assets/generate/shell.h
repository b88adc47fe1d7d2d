// Closed solids from the pieces of a sheet.
#pragma once

#include <functional>
#include <vector>

#include <glm/vec3.hpp>

#include "part_mesh.h"
#include "posts.h"
#include "sheet.h"

namespace livery::assets {

/// Where a post starts and ends, and how its walls face.
struct PostPlaces {
    glm::dvec3 outer_mm{0.0}, inner_mm{0.0};
    glm::dvec3 inward{0.0};           ///< across the border into the piece; 0 away from borders
    double outer_tolerance_mm = 0.0;  ///< how far the outer face may move here to have fewer
    double inner_tolerance_mm = 0.0;  ///< triangles, and the inner one; 0 keeps the vertex
    bool is_shaped = false;           ///< the outer face has its own normals here, not the sheet's
};

/// Appends each piece as an outer face with the sheet's normals, walls along its borders and an
/// inner face.
void add_shells(const Sheet& sheet,
                const Posts& posts,
                const std::vector<PostPlaces>& places,
                const ChartFunction& chart,
                const std::function<PartMesh&(int piece)>& part_of);

}  // namespace livery::assets
