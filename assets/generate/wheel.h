// A wheel about the origin, its axis along z, its outer face toward +z.
#pragma once

#include "part_mesh.h"

namespace livery::assets {

inline constexpr double kTyreRadius_mm = 13.5;
inline constexpr double kTyreHalfWidth_mm = 4.7;

PartMesh make_tyre();
PartMesh make_rim();
PartMesh make_brake();

}  // namespace livery::assets
