// What is lit: an indexed triangle mesh with named parts.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "appearance/material.h"
#include "mesh/length_unit.h"
#include "mesh/part_picture.h"

namespace livery {

/// Positions in files lie nearer than this, or the file is refused.
inline constexpr double kFarthestMm = 1e9;

struct Part {
    std::string name;
    std::string material_name;            ///< as the file names it; may be empty
    glm::dvec3 base_colour_rec709{0.5};   ///< the file's own colour, shown until a look says more
    std::optional<Material> paint{};      ///< where the file says more of it than a colour
    std::vector<PartPicture> pictures{};  ///< over that paint; a relief under any, one at most
};

/// What parts wear instead, as the file has it under a name; the others wear what they wear.
struct MeshVariant {
    std::string name;
    std::map<std::size_t, Part> parts;  ///< by index
};

/// World frame: right-handed, y up, millimetres. All vertex arrays have the same length; triangles
/// are counter-clockwise seen from outside.
struct Mesh {
    std::vector<glm::vec3> positions_mm;
    std::vector<glm::vec3> normals;   ///< unit
    std::vector<glm::vec4> tangents;  ///< unit xyz, w = +-1; v falls along cross(normal, xyz) * w
    std::vector<glm::vec2> uvs;
    std::vector<glm::uvec3> triangles;
    std::vector<std::uint16_t> triangle_part;  ///< index into parts, one a triangle
    /// One a triangle: of an open surface, so that light falls on its back as well and who is
    /// behind it sees that. The inside of a closed one is dark. Empty: all are closed.
    std::vector<bool> two_sided;
    std::vector<Part> parts;
    std::vector<MeshVariant> variants;
};

inline bool has_two_sides(const Mesh& mesh, std::uint32_t triangle) {
    return !mesh.two_sided.empty() && mesh.two_sided[triangle];
}

struct Bounds {
    glm::dvec3 low{0.0}, high{0.0};
};
Bounds bounds_of(const Mesh& mesh);

/// Area-weighted normals. Tangents along u; without UVs what +x becomes when +y turns the shortest
/// way into the normal, which changes little where the normal does, but for one facing down.
void compute_normals(Mesh& mesh);
void compute_tangents(Mesh& mesh);

/// Appends `other` with its parts, without its variants; part names get `prefix`.
void append(Mesh& mesh, const Mesh& other, const std::string& prefix);

/// A sphere of `rings` x 2 rings quads with one part; for tests, swatches and the sphere product.
Mesh make_sphere(glm::dvec3 centre_mm, double radius_mm, int rings, const std::string& part_name);

/// Loads glTF 2.0 (.gltf, .glb; metres), PLY or OBJ (in `unit`, else told from the size) and makes
/// of it what Mesh promises. Everything in the file is validated here. `notes` receives what was
/// dropped, repaired or assumed. Throws FileError.
Mesh load_mesh(const std::filesystem::path& file,
               std::vector<std::string>* notes = nullptr,
               std::optional<LengthUnit> unit = std::nullopt);

/// The same of a file's bytes; `file` names them in messages, and beside it lie the files that they
/// name.
Mesh read_mesh(const std::string& bytes,
               const std::filesystem::path& file,
               std::vector<std::string>* notes = nullptr,
               std::optional<LengthUnit> unit = std::nullopt);

}  // namespace livery
