// Whether a part of a mesh encloses a body.
#pragma once

#include <cstddef>

#include "mesh/mesh.h"

namespace livery {

/// Whether at every edge of the part two of its triangles meet, equal points being one. A part
/// without triangles encloses nothing.
bool is_closed(const Mesh& mesh, std::size_t part);

}  // namespace livery
