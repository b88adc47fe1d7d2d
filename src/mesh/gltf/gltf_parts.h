// The steps of read_gltf: where nodes stand, one primitive in the world, and a material. Internal
// to scene/.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>

#include "mesh/gltf/gltf_file.h"
#include "mesh/mesh.h"

namespace livery {

struct PlacedNode {
    std::size_t index = 0;
    glm::dmat4 world_from_node{1.0};  ///< metres
};

/// The nodes of the shown scene. glTF's graph is a forest: a second way to a node is a mistake.
/// `notes` receives those that are hidden.
std::vector<PlacedNode> placed_nodes(const GltfFile& gltf, std::vector<std::string>& notes);

/// Of a primitive's texture coordinates, those along which a material's pictures lie.
struct GltfUvs {
    int set = 0;
    glm::dmat3 picture_from_uv{1.0};  ///< KHR_texture_transform

    bool operator==(const GltfUvs&) const = default;
};

/// A part that wears a material of the file: its name, colour, paint and pictures.
struct GltfMaterial {
    Part part;
    GltfUvs uvs;
};

/// A primitive and where it stands in the file.
struct GltfPrimitive {
    const tinygltf::Primitive& content;
    std::string field;  ///< "meshes[0].primitives[2]"
    bool quantized = false;
    GltfUvs uvs;
};

/// One primitive in world millimetres, all of part 0 but without the part itself. Empty when
/// nothing of it is left. `notes` receives what was dropped or repaired.
Mesh build_primitive(const GltfFile& gltf,
                     GltfAccessors& accessors,
                     const GltfPrimitive& primitive,
                     const glm::dmat4& world_from_node,
                     const std::string& part_name,
                     std::vector<std::string>& notes);

struct GltfPicture {
    std::shared_ptr<const ArtworkPicture> picture;
    std::string note;  ///< why there is none, or what was done to it; may be empty
};

/// The pictures of textures, each read once.
class GltfPictures {
  public:
    explicit GltfPictures(const GltfFile& gltf);

    /// In linear colours, or as they stand in the file.
    const GltfPicture& of_texture(int texture, bool colours);

  private:
    GltfPicture read(int index, bool colours);

    const GltfFile& gltf_;
    std::size_t most_a_side_ = 0;
    std::size_t pixels_left_;                           ///< that may still be decoded
    std::map<std::pair<int, bool>, GltfPicture> read_;  ///< by image
};

/// Each texel the mean of those that it covers, or the one in which it lies.
ImageF resampled(const ImageF& picture, int width, int height);

/// What a material says of one point of its surface.
struct GltfSurface {
    glm::dvec3 base_rec709{1.0};
    double metallic = 1.0, roughness = 1.0, coat = 0.0, coat_roughness = 0.0;
};
GltfSurface surface_of(const tinygltf::Material& material);
/// As a paint of ours. `notes` receives what is not taken as it stands.
Material gltf_paint(const GltfFile& gltf,
                    std::size_t index,
                    const GltfSurface& surface,
                    const std::string& name,
                    std::vector<std::string>& notes);

/// Gives a part what the material's pictures say, and the paint and colour that they have in the
/// mean. `plain`: the material says nothing of gloss. `notes` receives what is not worn.
void wear_pictures(const GltfFile& gltf,
                   GltfPictures& pictures,
                   std::size_t index,
                   bool plain,
                   GltfMaterial& material,
                   std::vector<std::string>& notes);

/// Throws FileError.
GltfMaterial read_gltf_material(const GltfFile& gltf,
                                GltfPictures& pictures,
                                std::size_t index,
                                std::vector<std::string>& notes);

}  // namespace livery
