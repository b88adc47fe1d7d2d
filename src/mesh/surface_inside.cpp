#include <algorithm>
#include <cmath>

#include <glm/common.hpp>

#include "mesh/surface.h"

namespace livery {

namespace {

/// Cells a triangle may stand in, on average; large ones stand in many.
constexpr std::size_t kMostCells = 8;
constexpr std::size_t kLargestSide = 1024;

}  // namespace

std::size_t Insideness::cell_of(double value, int axis) const {
    const double extent = high_[axis] - low_[axis];
    if (!(extent > 0.0)) return 0;
    const double cell = (value - low_[axis]) / extent * static_cast<double>(side_);
    return static_cast<std::size_t>(std::clamp(cell, 0.0, static_cast<double>(side_ - 1)));
}

Insideness::Insideness(const Surface& surface,
                       const std::vector<std::uint32_t>& owner,
                       const std::vector<bool>& closed_owner)
    : surface_(surface), owner_(owner) {
    std::vector<std::uint32_t> closed;
    for (std::uint32_t t = 0; t < surface.triangles.size(); ++t) {
        if (closed_owner[owner[t]]) closed.push_back(t);
    }
    if (closed.empty()) return;
    low_ = high_ = glm::dvec3(surface.points[surface.triangles[closed[0]].x]);
    for (const std::uint32_t t : closed) {
        for (int k = 0; k < 3; ++k) {
            const glm::dvec3 point(surface.points[surface.triangles[t][k]]);
            low_ = glm::min(low_, point);
            high_ = glm::max(high_, point);
        }
    }
    /// The cells under the triangle's box: columns, then rows.
    const auto cells_of = [&](std::uint32_t t, auto&& visit) {
        const glm::uvec3& corners = surface_.triangles[t];
        const glm::dvec3 a(surface_.points[corners.x]), b(surface_.points[corners.y]),
            c(surface_.points[corners.z]);
        const glm::dvec3 low = glm::min(a, glm::min(b, c)), high = glm::max(a, glm::max(b, c));
        visit(cell_of(low.x, 0), cell_of(high.x, 0), cell_of(low.z, 2), cell_of(high.z, 2));
    };
    side_ = std::clamp(static_cast<std::size_t>(std::sqrt(static_cast<double>(closed.size()))),
                       std::size_t{1},
                       kLargestSide);
    for (;; side_ /= 2) {
        std::size_t places = 0;
        for (const std::uint32_t t : closed) {
            cells_of(t, [&](std::size_t x0, std::size_t x1, std::size_t z0, std::size_t z1) {
                places += (x1 - x0 + 1) * (z1 - z0 + 1);
            });
        }
        if (side_ == 1 || places <= kMostCells * closed.size()) break;
    }
    first_.assign(side_ * side_ + 1, 0);
    const auto each_cell = [&](std::uint32_t t, auto&& visit) {
        cells_of(t, [&](std::size_t x0, std::size_t x1, std::size_t z0, std::size_t z1) {
            for (std::size_t z = z0; z <= z1; ++z) {
                for (std::size_t x = x0; x <= x1; ++x) visit(z * side_ + x);
            }
        });
    };
    for (const std::uint32_t t : closed)
        each_cell(t, [&](std::size_t cell) { ++first_[cell + 1]; });
    for (std::size_t cell = 0; cell + 1 < first_.size(); ++cell) first_[cell + 1] += first_[cell];
    triangles_.resize(first_.back());
    std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
    for (const std::uint32_t t : closed) {
        each_cell(t, [&](std::size_t cell) { triangles_[next[cell]++] = t; });
    }
}

bool Insideness::inside_others(const glm::dvec3& point, std::uint32_t own) const {
    if (first_.empty()) return false;
    const std::size_t cell = cell_of(point.z, 2) * side_ + cell_of(point.x, 0);
    bool inside = false;
    for (std::uint32_t at = first_[cell]; at < first_[cell + 1]; ++at) {
        const std::uint32_t t = triangles_[at];
        if (owner_[t] == own) continue;
        const glm::uvec3& corners = surface_.triangles[t];
        // Seen from above, whether the point is within, edges belonging to one side only, so that
        // a ray through an edge meets one of its two triangles.
        bool within = false;
        for (int k = 0; k < 3; ++k) {
            const glm::dvec3 a(surface_.points[corners[k]]),
                b(surface_.points[corners[(k + 1) % 3]]);
            if ((a.z > point.z) == (b.z > point.z)) continue;
            const glm::dvec3 &from = a.z < b.z ? a : b, &to = a.z < b.z ? b : a;
            const double x = from.x + (to.x - from.x) * ((point.z - from.z) / (to.z - from.z));
            if (point.x < x) within = !within;
        }
        if (!within) continue;
        const glm::dvec3 a(surface_.points[corners.x]);
        const glm::dvec3 normal = area_vector(surface_, t);
        if (normal.y == 0.0) continue;
        const double height =
            a.y - (normal.x * (point.x - a.x) + normal.z * (point.z - a.z)) / normal.y;
        if (height > point.y) inside = !inside;
    }
    return inside;
}

}  // namespace livery
