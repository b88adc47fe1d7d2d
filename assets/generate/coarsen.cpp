#include "coarsen.h"

#include <algorithm>
#include <cstdint>
#include <optional>

#include <glm/geometric.hpp>

namespace livery::assets {

namespace {

constexpr double kTurn_cos = 0.906;
/// Of a triangle's longest edge, its least height: long thin ones bound nothing well.
constexpr double kSlenderness = 0.1;
constexpr double kLongest_mm = 10.0;

class Coarsener {
  public:
    Coarsener(const std::vector<glm::dvec3>& points,
              std::vector<glm::uvec3>& triangles,
              const std::vector<double>& tolerance)
        : points_(points),
          triangles_(triangles),
          tolerance_(tolerance),
          around_(points.size()),
          error_(points.size(), 0.0),
          is_gone_(triangles.size(), false) {
        for (std::uint32_t t = 0; t < triangles.size(); ++t) {
            first_normals_.push_back(normal(triangles[t]));
            for (int k = 0; k < 3; ++k) around_[triangles[t][k]].push_back(t);
        }
    }

    /// Collapses as many vertices as it may without touching a neighbourhood twice.
    std::size_t pass() {
        std::vector<bool> touched(points_.size(), false);
        std::size_t count = 0;
        for (std::uint32_t v = 0; v < points_.size(); ++v) {
            if (is_fixed(v) || touched[v] || around_[v].empty()) continue;
            const auto ring = neighbours(v);
            if (std::any_of(ring.begin(), ring.end(), [&](auto u) { return touched[u]; })) continue;
            const auto target = best_target(v, ring);
            if (!target) continue;
            for (const auto u : ring) touched[u] = true;
            collapse(v, target->vertex);
            error_[target->vertex] = std::max(error_[target->vertex], target->error);
            ++count;
        }
        return count;
    }

    std::vector<CoarseTriangle> result() const {
        std::vector<CoarseTriangle> kept;
        for (std::uint32_t t = 0; t < triangles_.size(); ++t) {
            if (!is_gone_[t]) kept.push_back({triangles_[t], t});
        }
        return kept;
    }

  private:
    struct Target {
        std::uint32_t vertex = 0;
        double error = 0.0;
    };

    bool is_fixed(std::uint32_t v) const { return tolerance_[v] <= 0.0; }
    glm::dvec3 normal(const glm::uvec3& t) const {
        const auto n = glm::cross(points_[t.y] - points_[t.x], points_[t.z] - points_[t.x]);
        const double length = glm::length(n);
        return length > 0.0 ? n / length : glm::dvec3(0.0);
    }

    std::vector<std::uint32_t> neighbours(std::uint32_t v) const {
        std::vector<std::uint32_t> ring;
        for (const auto t : around_[v]) {
            for (int k = 0; k < 3; ++k) {
                if (triangles_[t][k] != v) ring.push_back(triangles_[t][k]);
            }
        }
        std::sort(ring.begin(), ring.end());
        ring.erase(std::unique(ring.begin(), ring.end()), ring.end());
        return ring;
    }

    bool is_slender(const glm::uvec3& t) const {
        double longest = 0.0;
        for (int k = 0; k < 3; ++k) {
            longest = std::max(longest, glm::distance(points_[t[k]], points_[t[(k + 1) % 3]]));
        }
        const double twice_area =
            glm::length(glm::cross(points_[t.y] - points_[t.x], points_[t.z] - points_[t.x]));
        return longest > kLongest_mm || twice_area < kSlenderness * longest * longest;
    }

    /// How far the surface moves away from `v` when it collapses onto `u`; nothing where it may
    /// not.
    std::optional<double> cost(std::uint32_t v,
                               std::uint32_t u,
                               const std::vector<std::uint32_t>& ring) const {
        const auto ring_of_u = neighbours(u);
        std::vector<std::uint32_t> common;
        std::set_intersection(ring.begin(),
                              ring.end(),
                              ring_of_u.begin(),
                              ring_of_u.end(),
                              std::back_inserter(common));
        if (common.size() != 2) return std::nullopt;
        // No new edges between fixed vertices: they could cut a corner of the border, or lie in the
        // plane of symmetry.
        for (const auto w : ring) {
            const bool is_new = w != u && is_fixed(w) && is_fixed(u) &&
                                !std::binary_search(common.begin(), common.end(), w);
            if (is_new) return std::nullopt;
        }
        double farthest = 0.0;
        for (const auto t : around_[v]) {
            auto corners = triangles_[t];
            if (corners.x == u || corners.y == u || corners.z == u) continue;
            for (int k = 0; k < 3; ++k) {
                if (corners[k] == v) corners[k] = u;
            }
            const auto now = normal(corners);
            if (is_slender(corners) || glm::dot(now, first_normals_[t]) < kTurn_cos ||
                glm::dot(now, normal(triangles_[t])) < kTurn_cos) {
                return std::nullopt;
            }
            farthest = std::max(farthest, std::abs(glm::dot(now, points_[v] - points_[u])));
        }
        return farthest;
    }

    std::optional<Target> best_target(std::uint32_t v,
                                      const std::vector<std::uint32_t>& ring) const {
        std::optional<Target> best;
        for (const auto u : ring) {
            const auto moved = cost(v, u, ring);
            if (!moved) continue;
            const double error = std::max(error_[u], error_[v] + *moved);
            const double most =
                is_fixed(u) ? tolerance_[v] : std::min(tolerance_[u], tolerance_[v]);
            if (error <= most && (!best || error < best->error)) best = Target{u, error};
        }
        return best;
    }

    void collapse(std::uint32_t v, std::uint32_t u) {
        for (const auto t : around_[v]) {
            auto& corners = triangles_[t];
            if (corners.x == u || corners.y == u || corners.z == u) {
                is_gone_[t] = true;
                for (int k = 0; k < 3; ++k) {
                    if (corners[k] != v) std::erase(around_[corners[k]], t);
                }
                continue;
            }
            for (int k = 0; k < 3; ++k) {
                if (corners[k] == v) corners[k] = u;
            }
            around_[u].push_back(t);
        }
        around_[v].clear();
    }

    const std::vector<glm::dvec3>& points_;
    std::vector<glm::uvec3>& triangles_;
    const std::vector<double>& tolerance_;
    std::vector<std::vector<std::uint32_t>> around_;
    std::vector<double> error_;  ///< how far the surface may have moved near a vertex
    std::vector<glm::dvec3> first_normals_;
    std::vector<bool> is_gone_;
};

}  // namespace

std::vector<CoarseTriangle> coarsened(const std::vector<glm::dvec3>& points_mm,
                                      std::vector<glm::uvec3> triangles,
                                      const std::vector<double>& tolerance_mm) {
    Coarsener coarsener(points_mm, triangles, tolerance_mm);
    while (coarsener.pass() > 0) {
    }
    return coarsener.result();
}

}  // namespace livery::assets
