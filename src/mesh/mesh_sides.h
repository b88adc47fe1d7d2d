// The sides of a mesh's surfaces, whatever the file has wound.
#pragma once

#include <string>
#include <vector>

#include "mesh/mesh.h"

namespace livery {

/// Drops triangles without area or on top of others, winds each connected surface one way with its
/// outside out (as orient() has it), turns normals to that side, and fills two_sided. `said`: a
/// vertex each, whether its normal is the file's; others do not vote. `notes` receives what was
/// done.
void settle_sides(Mesh& mesh, std::vector<bool> said, std::vector<std::string>& notes);

}  // namespace livery
