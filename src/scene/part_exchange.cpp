#include "scene/part_exchange.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

#include <glm/geometric.hpp>

#include "core/random.h"
#include "core/statistics.h"

namespace livery {

namespace {

constexpr std::size_t kSenders = 2048, kReceiversAPart = 48;
constexpr double kLeast = 1e-6;

struct SurfacePlace {
    glm::dvec3 position_mm{0.0}, normal{0.0};
    double area_mm2 = 0.0;  ///< that it stands for
    std::size_t part = 0;
    bool two_sided = false;
};

glm::dvec3 corner(const Mesh& mesh, std::size_t triangle, int k) {
    return glm::dvec3(mesh.positions_mm[mesh.triangles[triangle][k]]);
}

/// Twice its area, along its outward normal.
glm::dvec3 area_vector(const Mesh& mesh, std::size_t triangle) {
    const glm::dvec3 a = corner(mesh, triangle, 0);
    return glm::cross(corner(mesh, triangle, 1) - a, corner(mesh, triangle, 2) - a);
}

/// `count` places over these triangles, each of them as likely as its area is large.
std::vector<SurfacePlace> places_on(const Mesh& mesh,
                                    const std::vector<double>& areas_mm2,
                                    const std::vector<std::uint32_t>& triangles,
                                    std::size_t count,
                                    Random& random) {
    std::vector<double> up_to;
    up_to.reserve(triangles.size());
    double area = 0.0;
    for (const std::uint32_t t : triangles) up_to.push_back(area += areas_mm2[t]);
    std::vector<SurfacePlace> places;
    if (!(area > 0.0)) return places;
    for (std::size_t k = 0; k < count; ++k) {
        const double at = (static_cast<double>(k) + random.uniform()) / static_cast<double>(count);
        const auto found = std::upper_bound(up_to.begin(), up_to.end(), at * area);
        const auto index =
            std::min(static_cast<std::size_t>(found - up_to.begin()), triangles.size() - 1);
        const std::uint32_t t = triangles[index];
        const glm::dvec3 outward = area_vector(mesh, t);
        if (!(glm::length(outward) > 0.0)) continue;
        const double u = std::sqrt(random.uniform()), v = random.uniform();
        SurfacePlace& place = places.emplace_back();
        place.position_mm = (1.0 - u) * corner(mesh, t, 0) + u * (1.0 - v) * corner(mesh, t, 1) +
                            u * v * corner(mesh, t, 2);
        place.normal = glm::normalize(outward);
        place.area_mm2 = area / static_cast<double>(count);
        place.part = mesh.triangle_part[t];
        place.two_sided = has_two_sides(mesh, t);
    }
    return places;
}

/// Of a disc of that area (its form factor at a point under it, bounded where both are near);
/// negative on the point's back.
double form_factor(const SurfacePlace& to, const SurfacePlace& from) {
    const glm::dvec3 way = from.position_mm - to.position_mm;
    const double distance2 = glm::dot(way, way);
    const double rises = glm::dot(to.normal, way), falls = -glm::dot(from.normal, way);
    if (rises == 0.0 || falls == 0.0) return 0.0;
    if ((rises < 0.0 && !to.two_sided) || (falls < 0.0 && !from.two_sided)) return 0.0;
    return rises / distance2 * std::abs(falls) * from.area_mm2 /
           (std::numbers::pi * distance2 + from.area_mm2);
}

}  // namespace

PartExchange part_exchange(const Mesh& mesh) {
    PartExchange exchange;
    exchange.parts = mesh.parts.size();
    exchange.share.assign(exchange.parts * exchange.parts, 0.0f);
    Random random(1);
    std::vector<std::uint32_t> all(mesh.triangles.size());
    std::vector<std::vector<std::uint32_t>> of_part(exchange.parts);
    std::vector<double> areas_mm2(mesh.triangles.size());
    for (std::uint32_t t = 0; t < all.size(); ++t) {
        all[t] = t;
        areas_mm2[t] = 0.5 * glm::length(area_vector(mesh, t));
        of_part[mesh.triangle_part[t]].push_back(t);
    }
    const std::vector<SurfacePlace> senders = places_on(mesh, areas_mm2, all, kSenders, random);
    for (std::size_t to = 0; to < exchange.parts; ++to) {
        std::vector<std::vector<double>> seen(exchange.parts);
        for (const SurfacePlace& receiver :
             places_on(mesh, areas_mm2, of_part[to], kReceiversAPart, random)) {
            std::vector<double> front(exchange.parts, 0.0), back(exchange.parts, 0.0);
            for (const SurfacePlace& sender : senders) {
                const double share = form_factor(receiver, sender);
                (share < 0.0 ? back : front)[sender.part] += std::abs(share);
            }
            for (std::size_t from = 0; from < exchange.parts; ++from) {
                seen[from].push_back(std::min(std::max(front[from], back[from]), 1.0));
            }
        }
        for (std::size_t from = 0; from < exchange.parts; ++from) {
            // Facets of what is convex face one another by rounding
            const double share = quantile(seen[from], 0.95);
            exchange.share[to * exchange.parts + from] =
                share < kLeast ? 0.0f : static_cast<float>(share);
        }
    }
    return exchange;
}

}  // namespace livery
