// A mesh as a file that other programs open as a scan.
#pragma once

#include <string>

#include "mesh/mesh.h"

namespace livery {

/// Positions (millimetres), normals and triangles as binary little-endian PLY; parts, UVs and
/// tangents are left out.
std::string ply_bytes(const Mesh& mesh);

}  // namespace livery
