// The steps of read_gltf: where nodes stand, one primitive in the world, and a material. Internal
// to scene/.
#pragma once

#include <string>
#include <vector>

#include <glm/mat4x4.hpp>

#include "mesh/gltf_file.h"
#include "mesh/mesh.h"

namespace livery {

struct PlacedNode {
    std::size_t index = 0;
    glm::dmat4 world_from_node{1.0};  ///< metres
};

/// The nodes of the shown scene. glTF's graph is a forest: a second way to a node is a mistake.
/// `notes` receives those that are hidden.
std::vector<PlacedNode> placed_nodes(const GltfFile& gltf, std::vector<std::string>& notes);

/// A primitive and where it stands in the file.
struct GltfPrimitive {
    const tinygltf::Primitive& content;
    std::string field;  ///< "meshes[0].primitives[2]"
    bool quantized = false;
};

/// One primitive in world millimetres, all of part 0 but without the part itself. Empty when
/// nothing of it is left. `notes` receives what was dropped or repaired.
Mesh build_primitive(const GltfFile& gltf,
                     GltfAccessors& accessors,
                     const GltfPrimitive& primitive,
                     const glm::dmat4& world_from_node,
                     const std::string& part_name,
                     std::vector<std::string>& notes);

/// A part that wears a material of the file: its name, colour and paint. `notes` receives what of
/// it is not read. Throws FileError.
Part read_gltf_material(const GltfFile& gltf, std::size_t index, std::vector<std::string>& notes);

}  // namespace livery
