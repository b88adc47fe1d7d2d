// Binary glTF 2.0 from parts.
#pragma once

#include <string>
#include <vector>

#include "part_mesh.h"

namespace livery::assets {

/// The bytes of a .glb: one node, mesh and material a part, named as the part; metres.
std::string glb_bytes(const std::string& name, const std::vector<PartMesh>& parts);

}  // namespace livery::assets
