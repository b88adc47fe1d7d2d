#include "radiance/subsurface/slab_thickness.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <glm/geometric.hpp>

#include "radiance/light/sphere_lookup.h"

namespace livery {

namespace {

constexpr float kParallel = -0.8f;  ///< cosine between the normals of both sides
constexpr float kSlant_tan = 0.577f;
constexpr int kSlants = 4;
/// Slanting rays go 1.15 times as far through a slab, .87 times through a ball.
constexpr float kAsInSlabs = 1.06f;

struct Inward {
    float distance_mm = 0.0f;
    bool opposite = false;
};
std::optional<Inward> inward(const Tracer& tracer,
                             const Mesh& product,
                             std::size_t part,
                             const glm::vec3& origin,
                             const glm::vec3& direction,
                             const glm::vec3& normal,
                             float most_mm) {
    TraceRay ray;
    ray.origin = origin;
    ray.direction = direction;
    ray.t_max = most_mm;
    const Hit hit = tracer.closest(ray);
    if (!hit.valid()) return std::nullopt;
    const SurfacePoint point = surface_point(product, hit);
    // From inside one meets the back of what is closed
    if (point.part != part || glm::dot(point.geometric_normal, direction) <= 0.0f) {
        return std::nullopt;
    }
    return Inward{glm::distance(point.position_mm, origin),
                  glm::dot(point.geometric_normal, normal) < kParallel};
}

}  // namespace

std::optional<float> slab_thickness_mm(const Tracer& tracer,
                                       const Mesh& product,
                                       std::size_t part,
                                       const glm::vec3& position_mm,
                                       const glm::vec3& normal,
                                       float most_mm) {
    const glm::vec3 origin = offset_origin(position_mm, -normal);
    const auto straight = inward(tracer, product, part, origin, -normal, normal, most_mm);
    if (!straight || !straight->opposite || !(straight->distance_mm > 0.0f)) return std::nullopt;
    const Basis around = basis_around(normal);
    float sum = 0.0f;
    for (int k = 0; k < kSlants; ++k) {
        const float angle = 1.5707963f * static_cast<float>(k) + 0.4f;
        const glm::vec3 way = glm::normalize(
            kSlant_tan * (std::cos(angle) * around.s + std::sin(angle) * around.t) - normal);
        const auto slanting =
            inward(tracer, product, part, origin, way, normal, 2.0f * straight->distance_mm);
        // One that gets out at a rim says nothing
        sum += slanting && slanting->opposite ? slanting->distance_mm : straight->distance_mm;
    }
    if (sum < kAsInSlabs * static_cast<float>(kSlants) * straight->distance_mm) return std::nullopt;
    return straight->distance_mm;
}

namespace {

/// Some places all over a part, by area.
struct Slabs {
    struct Place {
        float thickness_mm = 0.0f, area = 0.0f;
    };
    std::vector<Place> places;  ///< of slabs, the thinnest first
    float area = 0.0f, of_slabs = 0.0f;
};
Slabs slabs_of(const Tracer& tracer, const Mesh& product, std::size_t part, float most_mm) {
    constexpr std::size_t kTries = 400;
    std::vector<std::uint32_t> own;
    for (std::uint32_t t = 0; t < product.triangles.size(); ++t) {
        if (product.triangle_part[t] == part) own.push_back(t);
    }
    Slabs slabs;
    const std::size_t step = std::max<std::size_t>(1, own.size() / kTries);
    for (std::size_t k = 0; k < own.size(); k += step) {
        const glm::uvec3 c = product.triangles[own[k]];
        const glm::vec3 a = product.positions_mm[c.x];
        const glm::vec3 across =
            glm::cross(product.positions_mm[c.y] - a, product.positions_mm[c.z] - a);
        const float twice = glm::length(across);
        if (!(twice > 0.0f)) continue;
        slabs.area += twice;
        const glm::vec3 middle = (a + product.positions_mm[c.y] + product.positions_mm[c.z]) / 3.0f;
        const auto mm = slab_thickness_mm(tracer, product, part, middle, across / twice, most_mm);
        if (!mm) continue;
        slabs.of_slabs += twice;
        slabs.places.push_back({*mm, twice});
    }
    std::sort(
        slabs.places.begin(), slabs.places.end(), [](const Slabs::Place& x, const Slabs::Place& y) {
            return x.thickness_mm < y.thickness_mm;
        });
    return slabs;
}

}  // namespace

std::optional<float> sheet_thickness_mm(const Tracer& tracer,
                                        const Mesh& product,
                                        std::size_t part,
                                        float most_mm) {
    const Slabs slabs = slabs_of(tracer, product, part, most_mm);
    if (slabs.places.empty() || slabs.of_slabs < 0.8f * slabs.area) return std::nullopt;
    return slabs.places.back().thickness_mm;
}

std::optional<float> thinnest_slab_mm(const Tracer& tracer,
                                      const Mesh& product,
                                      std::size_t part,
                                      float most_mm) {
    const Slabs slabs = slabs_of(tracer, product, part, most_mm);
    if (!(slabs.of_slabs > 0.05f * slabs.area)) return std::nullopt;
    float sum = 0.0f;
    for (const Slabs::Place& one : slabs.places) {
        sum += one.area;
        if (sum >= 0.1f * slabs.of_slabs) return one.thickness_mm;
    }
    return std::nullopt;
}

}  // namespace livery
