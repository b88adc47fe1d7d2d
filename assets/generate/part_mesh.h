// A part of a product while it is being made: plain vertex arrays in double precision.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

namespace livery::assets {

/// One length unit of every texture chart: uv = millimetres / 180, so that a texture keeps its
/// scale from part to part.
inline constexpr double kUvUnit_mm = 180.0;

struct PartMesh {
    std::string name;
    glm::dvec3 base_colour_rec709{0.5};
    double roughness = 0.5;
    std::vector<glm::dvec3> positions_mm;
    std::vector<glm::dvec3> normals;  ///< unit
    std::vector<glm::dvec2> uvs;
    std::vector<glm::dvec4> tangents;   ///< filled by compute_tangents
    std::vector<glm::uvec3> triangles;  ///< counter-clockwise seen from outside

    std::uint32_t add_vertex(const glm::dvec3& position_mm,
                             const glm::dvec3& normal,
                             const glm::dvec2& uv);
    /// Skips a triangle that has two equal corners (the pole of a revolved profile).
    void add_triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c);
    /// Two triangles, split along the shorter diagonal.
    void add_quad(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d);
};

/// Appends `source` moved by `offset_mm`.
void append(PartMesh& target, const PartMesh& source, const glm::dvec3& offset_mm);

/// Appends the mirror image in the plane z = 0, with the winding reversed.
void append_mirrored(PartMesh& target, const PartMesh& source);

/// What a part is called and looks like before it is painted.
struct PartStyle {
    const char* name;
    glm::dvec3 base_colour_rec709;
    double roughness;
};

/// A product's parts from their halves at z >= 0, one for each style, with tangents.
std::vector<PartMesh> mirrored_parts(std::span<const PartStyle> styles,
                                     std::span<const PartMesh> halves);

/// Area-weighted normals from the triangles; vertices at one place (within a nanometre: the seams
/// of charts) share theirs.
void compute_smooth_normals(PartMesh& mesh);

/// Tangents along growing u, from the triangles' uv gradients, orthogonal to the normals; any
/// orthogonal direction where the chart is degenerate.
void compute_tangents(PartMesh& mesh);

}  // namespace livery::assets
