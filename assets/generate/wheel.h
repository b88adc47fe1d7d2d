// A wheel around the z axis, its outer face toward +z, its middle at z = 0.
#pragma once

#include "part_mesh.h"

namespace livery::assets {

inline constexpr double kTyreRadius_mm = 14.5;
inline constexpr double kTyreHalfWidth_mm = 5.08;

PartMesh make_tyre();
/// Barrel, hub, concave forked spokes, and the brake's disc behind them.
PartMesh make_rim();
/// The dark parts: the disc's hat, the caliper, the wheel's nuts.
PartMesh make_brake();

}  // namespace livery::assets
