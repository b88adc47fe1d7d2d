// The car mock-up: 180 x 75 x 60 mm, the front toward +x, y up, wheels on y = 0.
#pragma once

#include <vector>

#include "part_mesh.h"

namespace livery::assets {

/// Parts in this order: body, glass, rims, tyres, lights, trim; with normals, uvs and tangents.
std::vector<PartMesh> make_car();

}  // namespace livery::assets
