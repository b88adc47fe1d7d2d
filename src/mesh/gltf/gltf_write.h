// A mesh with what it wears as a glTF file that others open.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "appearance/material.h"
#include "mesh/mesh.h"

namespace livery {

/// What all parts wear, under a name.
struct MeshLook {
    std::string name;
    std::vector<Material> part_materials;  ///< one a part
};

/// The mesh as binary glTF 2.0 in metres, a node a part. The first look is what it wears, and all
/// are its KHR_materials_variants. A paint that glTF has no words for is written as what comes
/// nearest, with the whole paint in the material's extras, where load_mesh() finds it; of a
/// measured one the nearest stands alone, and `notes` says so. Throws std::invalid_argument: no
/// look, or one without a material for each part.
std::string gltf_bytes(const Mesh& mesh,
                       std::span<const MeshLook> looks,
                       std::vector<std::string>& notes);

}  // namespace livery
