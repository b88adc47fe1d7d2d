#include "solids.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <numeric>
#include <stdexcept>

#include <glm/geometric.hpp>

namespace livery::assets {

namespace {

constexpr double kPi = std::numbers::pi;

/// Outward normal of a profile's segment: the solid lies on the left.
glm::dvec2 segment_normal(const glm::dvec2& from, const glm::dvec2& to) {
    const auto along = glm::normalize(to - from);
    return {along.y, -along.x};
}

double cross(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// A simple counter-clockwise polygon as triangles, by clipping ears.
std::vector<glm::uvec3> polygon_triangles(const std::vector<glm::dvec2>& polygon) {
    std::vector<std::uint32_t> left(polygon.size());
    std::iota(left.begin(), left.end(), 0u);
    std::vector<glm::uvec3> triangles;
    const auto is_ear = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        if (cross(polygon[a], polygon[b], polygon[c]) <= 0.0) return false;
        return std::none_of(left.begin(), left.end(), [&](std::uint32_t p) {
            return p != a && p != b && p != c && cross(polygon[a], polygon[b], polygon[p]) >= 0.0 &&
                   cross(polygon[b], polygon[c], polygon[p]) >= 0.0 &&
                   cross(polygon[c], polygon[a], polygon[p]) >= 0.0;
        });
    };
    while (left.size() > 2) {
        const std::size_t n = left.size();
        std::size_t k = 0;
        while (k < n && !is_ear(left[(k + n - 1) % n], left[k], left[(k + 1) % n])) ++k;
        if (k == n) throw std::invalid_argument("polygon_triangles: the outline crosses itself");
        triangles.emplace_back(left[(k + n - 1) % n], left[k], left[(k + 1) % n]);
        left.erase(left.begin() + static_cast<std::ptrdiff_t>(k));
    }
    return triangles;
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
    if (full_turn || !closed) return mesh;
    const auto flat = polygon_triangles(profile);
    for (const bool at_end : {false, true}) {
        const double angle = at_end ? to_rad : from_rad;
        const double c = std::cos(angle), d = std::sin(angle);
        const auto base = static_cast<std::uint32_t>(mesh.positions_mm.size());
        for (const auto& p : profile) {
            mesh.add_vertex({p.x * c, p.x * d, p.y},
                            glm::dvec3(d, -c, 0.0) * (at_end ? -1.0 : 1.0),
                            p / kUvUnit_mm);
        }
        for (const auto& t : flat) {
            const auto u = t + base;
            at_end ? mesh.add_triangle(u.x, u.z, u.y) : mesh.add_triangle(u.x, u.y, u.z);
        }
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
    for (const bool at_end : {false, true}) {
        const auto& loop = at_end ? loops.back() : loops.front();
        glm::dvec3 middle(0.0), normal(0.0);
        for (const auto& p : loop) middle += p / static_cast<double>(n);
        for (std::uint32_t s = 0; s < n; ++s) {
            normal += glm::cross(loop[s] - middle, loop[(s + 1) % n] - middle);
        }
        normal = glm::normalize(at_end ? normal : -normal);
        const auto centre =
            mesh.add_vertex(middle, normal, mesh.uvs[at_end ? (loops.size() - 1) * n : 0]);
        const auto base = centre + 1;
        for (const auto& p : loop) {
            mesh.add_vertex(p, normal, mesh.uvs[centre] + glm::dvec2(p - middle) / kUvUnit_mm);
        }
        for (std::uint32_t s = 0; s < n; ++s) {
            const auto a = base + s, b = base + (s + 1) % n;
            at_end ? mesh.add_triangle(centre, a, b) : mesh.add_triangle(centre, b, a);
        }
    }
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
