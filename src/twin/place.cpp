#include "twin/place.h"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "core/mutation.h"
#include "core/parallel.h"
#include "core/random.h"
#include "twin/light_paths.h"

namespace livery {

MeshPlace mesh_place(const Mesh& mesh, const Hit& hit) {
    const glm::uvec3 corner = mesh.triangles[hit.triangle];
    const double b = hit.barycentric.x, c = hit.barycentric.y, a = 1.0 - b - c;
    const glm::dvec3 p0(mesh.positions_mm[corner.x]), p1(mesh.positions_mm[corner.y]),
        p2(mesh.positions_mm[corner.z]);
    MeshPlace place;
    place.position_mm = a * p0 + b * p1 + c * p2;
    place.geometric_normal = glm::cross(p1 - p0, p2 - p0);
    place.geometric_normal /= std::max(glm::length(place.geometric_normal), 1e-300);
    const glm::dvec3 n = a * glm::dvec3(mesh.normals[corner.x]) +
                         b * glm::dvec3(mesh.normals[corner.y]) +
                         c * glm::dvec3(mesh.normals[corner.z]);
    const double length = glm::length(n);
    place.normal = length > 1e-9 ? n / length : place.geometric_normal;
    place.part = mesh.triangle_part[hit.triangle];
    return place;
}

TraceRay shadow_ray(const glm::dvec3& position_mm,
                    const glm::dvec3& geometric_normal,
                    const glm::dvec3& toward_mm) {
    const glm::dvec3 side = glm::dot(geometric_normal, toward_mm - position_mm) < 0.0
                                ? -geometric_normal
                                : geometric_normal;
    TraceRay ray;
    ray.origin = offset_origin(glm::vec3(position_mm), glm::vec3(side));
    const glm::dvec3 path = toward_mm - glm::dvec3(ray.origin);
    const double length = glm::length(path);
    ray.direction = glm::vec3(path / length);
    ray.t_max = static_cast<float>(length * 0.9999);
    return ray;
}

bool sees(const Tracer& tracer,
          const glm::dvec3& position_mm,
          const glm::dvec3& geometric_normal,
          const glm::dvec3& place_mm) {
    return glm::dot(geometric_normal, place_mm - position_mm) > 0.0 &&
           !tracer.occluded(shadow_ray(position_mm, geometric_normal, place_mm));
}

std::optional<Illumination> illumination_of(const ProjectorDescription& projector,
                                            double reference_mm,
                                            const glm::dvec3& position_mm,
                                            const glm::dvec3& normal) {
    const View& view = projector.view;
    const glm::dvec3 to_light = centre_in_world(view) - position_mm;
    const double distance = glm::length(to_light);
    const double cosine = glm::dot(normal, to_light) / distance;
    if (!(cosine > 0.0)) return std::nullopt;
    const auto pixel = project(view, position_mm);
    if (!pixel || pixel->x < 0.0 || pixel->y < 0.0 || pixel->x >= view.width ||
        pixel->y >= view.height) {
        return std::nullopt;
    }
    Illumination light;
    light.pixel = static_cast<std::uint32_t>(pixel->y) * static_cast<std::uint32_t>(view.width) +
                  static_cast<std::uint32_t>(pixel->x);
    light.irradiance =
        LIVERY_MUTATED(twin_falloff, cosine * reference_mm * reference_mm / (distance * distance));
    if (projector.vignetting > 0.0) {
        const glm::dvec2 half(0.5 * view.width, 0.5 * view.height);
        const glm::dvec2 off = *pixel - half;
        light.irradiance *= 1.0 - projector.vignetting * glm::dot(off, off) / glm::dot(half, half);
    }
    return light;
}

PixelRectangle pixels_that_see(const View& view, const Mesh& mesh, int margin_px) {
    glm::dvec2 low(1e30), high(-1e30);
    for (const glm::vec3& vertex : mesh.positions_mm) {
        const auto pixel = project(view, glm::dvec3(vertex));
        if (!pixel) return {0, 0, view.width, view.height};
        low = glm::min(low, *pixel);
        high = glm::max(high, *pixel);
    }
    const auto clamped = [](double value, int limit) {
        return static_cast<int>(std::clamp(value, 0.0, static_cast<double>(limit)));
    };
    return {clamped(std::floor(low.x) - margin_px, view.width),
            clamped(std::floor(low.y) - margin_px, view.height),
            clamped(std::ceil(high.x) + margin_px, view.width),
            clamped(std::ceil(high.y) + margin_px, view.height)};
}

PixelRays::PixelRays(const View& view, const PixelRectangle& rectangle, int samples_a_side)
    : origin_(centre_in_world(view)),
      rectangle_(rectangle),
      stride_(static_cast<std::size_t>(rectangle.right - rectangle.left + 1)),
      samples_(samples_a_side) {
    const auto rows = static_cast<std::size_t>(rectangle.bottom - rectangle.top + 1);
    corners_.resize(stride_ * rows);
    parallel_for(rows, 8, [&](std::size_t begin, std::size_t end) {
        for (std::size_t row = begin; row < end; ++row) {
            for (std::size_t column = 0; column < stride_; ++column) {
                const glm::dvec2 pixel(rectangle.left + static_cast<int>(column),
                                       rectangle.top + static_cast<int>(row));
                corners_[row * stride_ + column] = glm::vec3(ray_through(view, pixel).direction);
            }
        }
    });
}

void PixelRays::add(int x, int y, std::vector<TraceRay>& rays) const {
    const auto* corner = corners_.data() + static_cast<std::size_t>(y - rectangle_.top) * stride_ +
                         static_cast<std::size_t>(x - rectangle_.left);
    const glm::vec3 dx = corner[1] - corner[0], dy = corner[stride_] - corner[0],
                    dxy = corner[stride_ + 1] - corner[stride_] - dx;
    const float step = 1.0f / static_cast<float>(samples_);
    for (int s = 0; s < samples_ * samples_; ++s) {
        const auto bits = hash_3d(static_cast<std::uint32_t>(x),
                                  static_cast<std::uint32_t>(y),
                                  static_cast<std::uint32_t>(s));
        const float jx = static_cast<float>(bits & 0xffffu) * 0x1p-16f;
        const float jy = static_cast<float>(bits >> 16u) * 0x1p-16f;
        const float u = (static_cast<float>(s % samples_) + jx) * step;
        const float v = (static_cast<float>(s / samples_) + jy) * step;
        TraceRay ray;
        ray.origin = origin_;
        ray.direction = glm::normalize(corner[0] + u * dx + v * dy + u * v * dxy);
        rays.push_back(ray);
    }
}

}  // namespace livery
