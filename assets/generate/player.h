// A hand-held media player of our own design: 62 x 104 x 11 mm, the front toward +x, y up.
#pragma once

#include <vector>

#include "part_mesh.h"

namespace livery::assets {

/// Parts in this order: shell, back, glass, wheel, button, trim; with normals, uvs and tangents. It
/// is centred and symmetric in z = 0; the shell's wall is 1.6 mm thick.
std::vector<PartMesh> make_player();

}  // namespace livery::assets
