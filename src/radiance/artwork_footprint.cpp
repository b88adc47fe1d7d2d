#include "radiance/artwork_footprint.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "core/parallel.h"

namespace livery {

namespace {

/// The least cosine that a footprint is stretched by.
constexpr double kLeastCosine = 1.0 / 30.0;

/// Along u and v of the triangle that the fragment's first sample met, carried on from there.
FlatFootprint on_uv(const Mesh& mesh,
                    const SurfaceSample& sample,
                    const Fragment& fragment,
                    const Footprint& footprint) {
    const glm::uvec3 corner = mesh.triangles[sample.triangle];
    const glm::dvec3 origin(mesh.positions_mm[corner.x]);
    const glm::dvec3 e1 = glm::dvec3(mesh.positions_mm[corner.y]) - origin;
    const glm::dvec3 e2 = glm::dvec3(mesh.positions_mm[corner.z]) - origin;
    const glm::dvec2 uv(mesh.uvs[corner.x]);
    const glm::dvec2 d1 = glm::dvec2(mesh.uvs[corner.y]) - uv;
    const glm::dvec2 d2 = glm::dvec2(mesh.uvs[corner.z]) - uv;
    // Weights of the edges that come closest to a vector, by the edges' inner products
    const double m11 = glm::dot(e1, e1), m12 = glm::dot(e1, e2), m22 = glm::dot(e2, e2);
    const double determinant = m11 * m22 - m12 * m12;
    const auto along = [&](const glm::dvec3& v) {
        if (!(determinant > 1e-12 * m11 * m22)) return glm::dvec2(0.0);
        const double p = glm::dot(v, e1), q = glm::dot(v, e2);
        return ((m22 * p - m12 * q) * d1 + (m11 * q - m12 * p) * d2) / determinant;
    };
    return {uv + along(glm::dvec3(fragment.position_mm) - origin),
            along(footprint.a),
            along(footprint.b)};
}

FlatFootprint on_plane(const ArtworkPlane& plane,
                       const Fragment& fragment,
                       const Footprint& footprint) {
    const auto along = [&](const glm::dvec3& v) {
        return glm::dvec2(glm::dot(plane.s_axis, v), glm::dot(plane.t_axis, v));
    };
    return {plane * glm::dvec3(fragment.position_mm), along(footprint.a), along(footprint.b)};
}

}  // namespace

Footprint footprint_of(const View& view,
                       std::uint32_t pixel,
                       const glm::dvec3& position_mm,
                       const glm::dvec3& normal) {
    const auto width = static_cast<std::uint32_t>(view.width);
    const glm::dvec2 corner(pixel % width, pixel / width);
    const auto direction = [&](double x, double y) {
        return ray_through(view, corner + glm::dvec2(x, y)).direction;
    };
    const glm::dvec3 from = position_mm - centre_in_world(view);
    const double distance = glm::length(from);
    const glm::dvec3 ray = from / distance;
    double cosine = glm::dot(ray, normal);
    cosine = std::copysign(std::max(std::abs(cosine), kLeastCosine), cosine);
    const auto on_surface = [&](const glm::dvec3& step) {
        return distance * (step - (glm::dot(step, normal) / cosine) * ray);
    };
    return {on_surface(direction(1.0, 0.5) - direction(0.0, 0.5)),
            on_surface(direction(0.5, 1.0) - direction(0.5, 0.0))};
}

std::vector<Footprint> footprints_of(const View& view, const SurfaceMap& map, std::size_t part) {
    const std::size_t first = map.part_begin[part];
    std::vector<Footprint> footprints(map.part_begin[part + 1] - first);
    parallel_for(footprints.size(), 1024, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) {
            const Fragment& f = map.fragments[first + k];
            footprints[k] =
                footprint_of(view, f.pixel, glm::dvec3(f.position_mm), glm::dvec3(f.normal));
        }
    });
    return footprints;
}

FlatFootprint flat_footprint(const Mesh& mesh,
                             const SurfaceMap& map,
                             std::size_t fragment,
                             const Footprint& footprint,
                             const PartArtwork& artwork,
                             const ArtworkPlane& plane) {
    const Fragment& f = map.fragments[fragment];
    if (!artwork.artwork.place.by_uv) return on_plane(plane, f, footprint);
    return on_uv(mesh, map.samples[fragment * kSamplesAFragment], f, footprint);
}

}  // namespace livery
