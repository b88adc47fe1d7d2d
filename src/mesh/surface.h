// A soup of triangles as a surface: what is one point, which triangles are neighbours, which side
// is out. Internal to mesh/.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

namespace livery {

struct Surface {
    static constexpr std::uint32_t none = 0xffffffffu;
    std::vector<glm::vec3> points;
    std::vector<glm::uvec3> triangles;  ///< of points
    /// The triangle across the edge from corner k to corner k + 1, where two meet there; `none` at
    /// a border and where three or more meet.
    std::vector<std::array<std::uint32_t, 3>> neighbours;
    std::vector<bool> lone;  ///< a triangle with an edge at a border, or one that three share
};

/// Names equal points once. The place of each in the shorter list.
std::vector<std::uint32_t> weld(const std::vector<glm::vec3>& points,
                                std::vector<glm::vec3>& distinct);

void find_neighbours(Surface& surface);

/// Which triangles have the corners of an earlier one, in whatever order.
std::vector<bool> repeated_triangles(const Surface& surface);

/// Twice the area times the normal.
glm::dvec3 area_vector(const Surface& surface, std::size_t triangle);

/// Whether the corners span a triangle wider than the resolution of float coordinates.
bool has_area(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c);

struct Orientation {
    std::vector<bool> turned;  ///< a triangle each: its corners were exchanged
    std::size_t against = 0;   ///< triangles turned because their neighbours said so
    std::size_t inward = 0;    ///< surfaces turned whole
    std::size_t inward_triangles = 0;
    std::size_t cavities = 0;   ///< closed ones inside others, which rightly face inward
    std::size_t one_sided = 0;  ///< surfaces that no winding fits (Moebius strips)
    /// A triangle each: of a surface that encloses nothing, so that both of its sides show.
    std::vector<bool> open;
};

/// Winds each connected surface one way and its outside out: a closed one by its volume; an open
/// one by `normals` (a triangle each, zero where the file has none), else by how it bulges, else by
/// how most of it was wound. Needs neighbours.
Orientation orient(Surface& surface, const std::vector<glm::vec3>& normals);

/// What orient() did, for who reads of it. "3 triangles", "1 triangle".
void note_orientation(const Orientation& orientation, std::vector<std::string>& notes);
std::string counted(std::size_t count, const char* one, const char* many);

/// For each triangle the normals of its corners, weighted with angles over the triangles around the
/// corner's point that hang together without an edge sharper than `crease_rad`. Equal corners have
/// equal `group`s. Needs neighbours.
struct CornerNormals {
    std::vector<std::array<std::uint32_t, 3>> group;
    std::vector<glm::vec3> normal_of_group;
};
CornerNormals compute_corner_normals(const Surface& surface, double crease_rad);

/// Whether a point lies inside closed surfaces; parity along a ray.
class Insideness {
  public:
    /// Of the triangles of which `closed` says so; `owner` tells surfaces apart.
    Insideness(const Surface& surface,
               const std::vector<std::uint32_t>& owner,
               const std::vector<bool>& closed_owner);
    /// Whether the point is inside an odd number of surfaces other than `own`.
    bool inside_others(const glm::dvec3& point, std::uint32_t own) const;

  private:
    std::size_t cell_of(double value, int axis) const;
    const Surface& surface_;
    const std::vector<std::uint32_t>& owner_;
    glm::dvec3 low_{0.0}, high_{0.0};
    std::size_t side_ = 1;
    std::vector<std::uint32_t> first_, triangles_;  ///< a grid over x and z
};

}  // namespace livery
