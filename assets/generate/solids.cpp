#include "solids.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

#include <glm/geometric.hpp>

namespace livery::assets {

namespace {

constexpr double kPi = std::numbers::pi;

/// Outward normal of a profile's segment: the solid lies on the left.
glm::dvec2 segment_normal(const glm::dvec2& from, const glm::dvec2& to) {
    const auto along = glm::normalize(to - from);
    return {along.y, -along.x};
}

}  // namespace

PartMesh revolve(const std::vector<glm::dvec2>& profile,
                 bool closed,
                 int segments,
                 double from_rad,
                 double to_rad) {
    constexpr double kSharp_cos = 0.82;
    const std::size_t n = profile.size();
    const std::size_t pieces = closed ? n : n - 1;
    const auto normal_of = [&](std::size_t piece) {
        return segment_normal(profile[piece % n], profile[(piece + 1) % n]);
    };
    const auto end_normal = [&](std::size_t piece, bool at_end) {
        const bool has_next = at_end ? (closed || piece + 1 < pieces) : (closed || piece > 0);
        const auto own = normal_of(piece);
        if (!has_next) return own;
        const auto next = normal_of(at_end ? (piece + 1) % pieces : (piece + pieces - 1) % pieces);
        return glm::dot(own, next) < kSharp_cos ? own : glm::normalize(own + next);
    };
    const bool full_turn = to_rad - from_rad > 2.0 * kPi - 1e-9;
    PartMesh mesh;
    double along_mm = 0.0;
    for (std::size_t piece = 0; piece < pieces; ++piece) {
        const auto& a = profile[piece];
        const auto& b = profile[(piece + 1) % n];
        const auto base = static_cast<std::uint32_t>(mesh.positions_mm.size());
        const auto na = end_normal(piece, false), nb = end_normal(piece, true);
        const double next_mm = along_mm + glm::distance(a, b);
        for (int s = 0; s <= segments; ++s) {
            const double f = static_cast<double>(s) / segments;
            const int turned = full_turn && s == segments ? 0 : s;
            const double angle = from_rad + (to_rad - from_rad) * turned / segments;
            const double c = std::cos(angle), d = std::sin(angle);
            // The chart is developed at the larger radius of the profile.
            const double u = f * (to_rad - from_rad) * std::max(a.x, b.x) / kUvUnit_mm;
            mesh.add_vertex({a.x * c, a.x * d, a.y},
                            glm::normalize(glm::dvec3(na.x * c, na.x * d, na.y)),
                            {u, along_mm / kUvUnit_mm});
            mesh.add_vertex({b.x * c, b.x * d, b.y},
                            glm::normalize(glm::dvec3(nb.x * c, nb.x * d, nb.y)),
                            {u, next_mm / kUvUnit_mm});
        }
        for (int s = 0; s < segments; ++s) {
            const auto v = base + 2 * static_cast<std::uint32_t>(s);
            if (a.x > 0.0) mesh.add_triangle(v, v + 2, b.x > 0.0 ? v + 3 : v + 1);
            if (b.x > 0.0) mesh.add_triangle(v, v + 3, v + 1);
        }
        along_mm = next_mm;
    }
    return mesh;
}

PartMesh loft(const std::vector<std::vector<glm::dvec3>>& loops) {
    PartMesh mesh;
    const auto n = static_cast<std::uint32_t>(loops.front().size());
    double along_mm = 0.0;
    for (std::size_t k = 0; k < loops.size(); ++k) {
        if (k > 0) along_mm += glm::distance(loops[k][0], loops[k - 1][0]);
        double around_mm = 0.0;
        for (std::uint32_t s = 0; s < n; ++s) {
            if (s > 0) around_mm += glm::distance(loops[k][s], loops[k][s - 1]);
            mesh.add_vertex(
                loops[k][s], glm::dvec3(0.0), glm::dvec2(along_mm, around_mm) / kUvUnit_mm);
        }
    }
    for (std::uint32_t k = 0; k + 1 < loops.size(); ++k) {
        for (std::uint32_t s = 0; s < n; ++s) {
            const auto a = k * n + s, b = k * n + (s + 1) % n;
            mesh.add_quad(a, b, b + n, a + n);
        }
    }
    compute_smooth_normals(mesh);
    return mesh;
}

PartMesh sphere(double radius_mm, int rings) {
    std::vector<glm::dvec2> profile;
    for (int k = 0; k <= rings; ++k) {
        const double angle = kPi * k / rings;
        const bool pole = k == 0 || k == rings;
        profile.emplace_back(pole ? 0.0 : radius_mm * std::sin(angle),
                             -radius_mm * std::cos(angle));
    }
    PartMesh mesh;
    const int segments = 2 * rings;
    for (int k = 0; k <= rings; ++k) {
        for (int s = 0; s <= segments; ++s) {
            const double turn = 2.0 * kPi * (s == segments ? 0 : s) / segments;
            const auto& p = profile[static_cast<std::size_t>(k)];
            // Turned about y, the pole up.
            const glm::dvec3 at(p.x * std::sin(turn), p.y, p.x * std::cos(turn));
            mesh.add_vertex(at,
                            glm::normalize(at),
                            glm::dvec2(2.0 * kPi * s / segments, kPi * (rings - k) / rings) *
                                (radius_mm / kUvUnit_mm));
        }
    }
    const auto row = static_cast<std::uint32_t>(segments + 1);
    for (std::uint32_t k = 0; k < static_cast<std::uint32_t>(rings); ++k) {
        for (std::uint32_t s = 0; s + 1 < row; ++s) {
            const auto a = k * row + s, b = a + 1, c = a + row + 1, d = a + row;
            if (k > 0) mesh.add_triangle(a, b, c);
            if (k + 1 < static_cast<std::uint32_t>(rings)) mesh.add_triangle(a, c, d);
        }
    }
    return mesh;
}

}  // namespace livery::assets
