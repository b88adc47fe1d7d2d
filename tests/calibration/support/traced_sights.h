// What decoded photographs would tell, traced: where a camera sees each projector pixel, with noise
// and with the edges that decoding leaves out.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <glm/geometric.hpp>

#include "calibration/scan/scan.h"
#include "core/random.h"
#include "mesh/mesh.h"
#include "tracing/tracer.h"

namespace livery::testing {

/// `world` is all that stands there, mock-up and table. Noise is Gaussian, in camera pixels.
inline Sight traced_sight(const Mesh& world,
                          const View& projector,
                          const View& camera,
                          double noise_px,
                          std::uint64_t seed) {
    const Tracer tracer(world);
    const int width = projector.width, height = projector.height;
    const float nan = std::numeric_limits<float>::quiet_NaN();
    Sight sight{camera, {ImageF(width, height, 2, nan), Image8(width, height, 1), {}}};
    const glm::dvec3 lamp = centre_in_world(projector), eye = centre_in_world(camera);
    std::vector<float> range(static_cast<std::size_t>(width) * static_cast<std::size_t>(height),
                             0.0f);
    Random random(seed);
    for (int y = 0; y < height; ++y) {
        std::vector<glm::vec3> directions;
        for (int x = 0; x < width; ++x)
            directions.emplace_back(ray_through(projector, {x + 0.5, y + 0.5}).direction);
        std::vector<Hit> hits(directions.size());
        tracer.closest_from(glm::vec3(lamp), directions, hits);
        for (int x = 0; x < width; ++x) {
            const Hit& hit = hits[static_cast<std::size_t>(x)];
            if (!hit.valid()) continue;
            range[static_cast<std::size_t>(y * width + x)] = hit.t;
            const SurfacePoint point = surface_point(world, hit);
            const glm::dvec3 normal(point.geometric_normal);
            const glm::dvec3 place = lamp + static_cast<double>(hit.t) *
                                                glm::dvec3(directions[static_cast<std::size_t>(x)]);
            const glm::dvec3 to_eye = eye - place;
            const double distance = glm::length(to_eye);
            if (glm::dot(normal, to_eye) < 0.1 * distance) continue;
            if (glm::dot(normal, lamp - place) < 0.1 * static_cast<double>(hit.t)) continue;
            TraceRay ray;
            ray.origin = offset_origin(glm::vec3(place), point.geometric_normal);
            ray.direction = glm::vec3(to_eye / distance);
            ray.t_max = static_cast<float>(distance);
            const auto pixel = project(camera, place);
            if (!pixel || pixel->x < 0 || pixel->y < 0 || pixel->x > camera.width ||
                pixel->y > camera.height || tracer.occluded(ray))
                continue;
            sight.map.camera_px.at(x, y, 0) =
                static_cast<float>(pixel->x + noise_px * random.normal());
            sight.map.camera_px.at(x, y, 1) =
                static_cast<float>(pixel->y + noise_px * random.normal());
        }
    }
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (int k = 0; k < 4; ++k) {
                const int nx = x + (k == 0) - (k == 1), ny = y + (k == 2) - (k == 3);
                if (nx < 0 || ny < 0 || nx >= width || ny >= height) continue;
                const float a = range[static_cast<std::size_t>(y * width + x)];
                const float b = range[static_cast<std::size_t>(ny * width + nx)];
                if (std::abs(a - b) > 0.005f * a) sight.map.edge.at(x, y) = 255;
            }
    return sight;
}

/// A rectangle of two triangles; `mesh` grows by it.
inline void add_rectangle(Mesh& mesh, glm::vec3 corner, glm::vec3 side_a, glm::vec3 side_b) {
    Mesh other;
    other.positions_mm = {corner, corner + side_a, corner + side_a + side_b, corner + side_b};
    other.triangles = {{0, 1, 2}, {0, 2, 3}};
    other.triangle_part = {0, 0};
    other.uvs.assign(4, glm::vec2(0.0f));
    other.parts.resize(1);
    compute_normals(other);
    compute_tangents(other);
    append(mesh, other, "surroundings ");
}

/// Each place of the mesh moved by its own Gaussian offset along the normal; equal places alike.
inline Mesh roughened(Mesh mesh, double rms_mm) {
    for (std::size_t i = 0; i < mesh.positions_mm.size(); ++i) {
        glm::vec3& place = mesh.positions_mm[i];
        const auto bits = [](float value) {
            return static_cast<std::uint32_t>(
                static_cast<std::int32_t>(std::lround(value * 512.0f)));
        };
        Random random(hash_3d(bits(place.x), bits(place.y), bits(place.z)));
        place += static_cast<float>(rms_mm * random.normal()) * mesh.normals[i];
    }
    compute_normals(mesh);
    return mesh;
}

}  // namespace livery::testing
