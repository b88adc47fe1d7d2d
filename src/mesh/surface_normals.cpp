#include <algorithm>
#include <cmath>
#include <numeric>

#include <glm/geometric.hpp>

#include "mesh/surface.h"

namespace livery {

namespace {

/// Sets of corners that share a normal.
class Sets {
  public:
    explicit Sets(std::size_t count) : parent_(count) {
        std::iota(parent_.begin(), parent_.end(), 0u);
    }
    std::uint32_t root(std::uint32_t k) {
        while (parent_[k] != k) k = parent_[k] = parent_[parent_[k]];
        return k;
    }
    void unite(std::uint32_t a, std::uint32_t b) {
        a = root(a);
        b = root(b);
        if (a != b) parent_[std::max(a, b)] = std::min(a, b);
    }

  private:
    std::vector<std::uint32_t> parent_;
};

std::uint32_t corner_at(const Surface& surface, std::uint32_t triangle, std::uint32_t point) {
    const glm::uvec3& t = surface.triangles[triangle];
    return 3 * triangle + (t.x == point ? 0u : t.y == point ? 1u : 2u);
}

/// The angle between two edges, well-conditioned near 0 and pi.
double angle_between(const glm::dvec3& a, const glm::dvec3& b) {
    return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

}  // namespace

CornerNormals compute_corner_normals(const Surface& surface, double crease_rad) {
    const auto count = static_cast<std::uint32_t>(surface.triangles.size());
    std::vector<glm::dvec3> flat(count);
    for (std::uint32_t t = 0; t < count; ++t) {
        const glm::dvec3 vector = area_vector(surface, t);
        flat[t] = vector / glm::length(vector);
    }
    Sets sets(3 * std::size_t{count});
    const double least = std::cos(crease_rad);
    for (std::uint32_t t = 0; t < count; ++t) {
        for (int k = 0; k < 3; ++k) {
            const std::uint32_t other = surface.neighbours[t][static_cast<std::size_t>(k)];
            // Each edge once, from its later triangle.
            if (other >= t || glm::dot(flat[t], flat[other]) < least) continue;
            for (const int end : {k, (k + 1) % 3}) {
                sets.unite(3 * t + static_cast<std::uint32_t>(end),
                           corner_at(surface, other, surface.triangles[t][end]));
            }
        }
    }

    CornerNormals normals;
    normals.group.resize(count);
    std::vector<std::uint32_t> group_of_root(3 * std::size_t{count}, Surface::none);
    std::vector<glm::dvec3> sums;
    std::vector<std::uint32_t> a_triangle;  // of each group
    for (std::uint32_t t = 0; t < count; ++t) {
        const glm::uvec3& corners = surface.triangles[t];
        for (std::uint32_t k = 0; k < 3; ++k) {
            std::uint32_t& group = group_of_root[sets.root(3 * t + k)];
            if (group == Surface::none) {
                group = static_cast<std::uint32_t>(sums.size());
                sums.emplace_back(0.0);
                a_triangle.push_back(t);
            }
            const auto point = [&](std::uint32_t corner) {
                return glm::dvec3(surface.points[corners[static_cast<int>(corner % 3)]]);
            };
            const double angle = angle_between(point(k + 1) - point(k), point(k + 2) - point(k));
            sums[group] += angle * flat[t];
            normals.group[t][k] = group;
        }
    }
    normals.normal_of_group.reserve(sums.size());
    for (std::size_t group = 0; group < sums.size(); ++group) {
        const double length = glm::length(sums[group]);
        // All around a needle's tip normals cancel: one of them is as good as the others.
        normals.normal_of_group.emplace_back(length > 1e-9 ? sums[group] / length
                                                           : flat[a_triangle[group]]);
    }
    return normals;
}

}  // namespace livery
