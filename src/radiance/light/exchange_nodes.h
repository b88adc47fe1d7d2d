// Points all over a mesh between which light is exchanged.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "mesh/mesh.h"

namespace livery {

/// Where a mesh may have its light looked up: its vertices, and a grid in every triangle that is
/// longer than what lies between two nodes.
struct ExchangePoints {
    std::vector<glm::vec3> positions_mm, normals;  ///< of each; the unit shading normal
    std::vector<std::uint32_t> within;             ///< a triangle that it lies in
    std::vector<glm::vec2> uvs;
    std::vector<std::uint16_t> part;
    /// Of each triangle: steps a side, 1 where its corners are its points; the first of its grid.
    std::vector<std::uint16_t> steps;
    std::vector<std::uint32_t> grid;
    /// The same place on the back of the surface, where that shows; kNoBack elsewhere. Empty: no
    /// back does.
    std::vector<std::uint32_t> back;
    static constexpr std::uint32_t kNoBack = 0xffffffffu;

    float apart_mm = 0.0f;  ///< from one node to the next

    std::size_t size() const { return positions_mm.size(); }

    struct Share {
        std::uint32_t index = 0;
        float weight = 0.0f;
    };
    /// The three points around a place of a triangle, by linear weights that sum to 1.
    std::array<Share, 3> around(const Mesh& mesh,
                                std::uint32_t triangle,
                                const glm::vec2& barycentric) const;
    /// A point or its back, whichever lies on the side of `normal`; kNoBack: neither.
    std::uint32_t on_side(std::uint32_t point, const glm::vec3& normal) const {
        if (glm::dot(normals[point], normal) > 0.0f) return point;
        return back.empty() ? kNoBack : back[point];
    }
};

/// Points that lie close together, on one part and with normals that differ little, share a node:
/// one of them. Between nodes light is interpolated.
struct ExchangeNodes {
    ExchangePoints points;
    std::vector<std::uint32_t> point_of;  ///< of each node
    std::vector<std::uint32_t> node_of;   ///< of each point
    /// Nodes around each point, by weights that sum to 1, from `first` on.
    std::vector<std::uint32_t> first;
    std::vector<ExchangePoints::Share> nearby;

    std::size_t size() const { return point_of.size(); }
    const glm::vec3& position_mm(std::size_t node) const {
        return points.positions_mm[point_of[node]];
    }
    const glm::vec3& normal(std::size_t node) const { return points.normals[point_of[node]]; }
    std::uint16_t part(std::size_t node) const { return points.part[point_of[node]]; }
    /// Where its rays start: off the surface, and a little inside its triangle, for at an edge
    /// they would start within what meets there.
    glm::vec3 ray_origin_mm(const Mesh& mesh, std::size_t node) const;

    /// One of the nodes around a place of a triangle, or of its back: as often as it weighs there
    /// for a `chance` in [0, 1).
    std::uint32_t around(const Mesh& mesh,
                         std::uint32_t triangle,
                         const glm::vec2& barycentric,
                         bool behind,
                         float chance) const;

    /// Of each point, from a value of each node.
    std::vector<glm::vec3> at_points(const std::vector<glm::vec3>& at_nodes) const;
    /// Interpolation blurs: values of which it gives `at_nodes` where they lie, but for the fourth
    /// order, of what is smooth (Van Cittert's first step). Never below 0. What else has blurred
    /// them is taken off as well: `blur` is the variance of all over that of interpolation.
    std::vector<glm::vec3> sharpened(const std::vector<glm::vec3>& at_nodes,
                                     float blur = 1.0f) const;
};

/// Nodes are a hundredth of the mesh's diagonal apart, or farther where that would make too many
/// points.
ExchangeNodes exchange_nodes(const Mesh& mesh);
/// As far apart as that, or farther in the same case.
ExchangeNodes exchange_nodes(const Mesh& mesh, double apart_mm);

/// Of each node, the area of the surface that is nearest to its points: all add up to the mesh's.
std::vector<float> node_areas_mm2(const Mesh& mesh, const ExchangeNodes& nodes);
/// Where rays start that ask for all of that area: `count` of each node, as far apart as areas go,
/// off the surface.
std::vector<glm::vec3> ray_origins_mm(const Mesh& mesh,
                                      const ExchangeNodes& nodes,
                                      std::span<const float> areas_mm2,
                                      std::size_t count);

}  // namespace livery
