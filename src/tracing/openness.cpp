#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

#include "core/error.h"
#include "core/mutation.h"
#include "core/parallel.h"
#include "core/random.h"
#include "tracing/tracer.h"

namespace livery {

namespace {

/// Two unit vectors orthogonal to `n` and to each other (Duff et al. 2017).
void make_basis(const glm::vec3& n, glm::vec3& s, glm::vec3& t) {
    const float sign = std::copysign(1.0f, n.z);
    const float a = -1.0f / (sign + n.z);
    const float b = n.x * n.y * a;
    s = {1.0f + sign * n.x * n.x * a, sign * b, -sign * n.x};
    t = {b, sign + n.y * n.y * a, -n.y};
}

}  // namespace

std::vector<float> ambient_openness(const Tracer& tracer,
                                    std::span<const glm::vec3> positions_mm,
                                    std::span<const glm::vec3> normals,
                                    int ray_count,
                                    float max_distance_mm) {
    check_argument(positions_mm.size() == normals.size(),
                   "ambient_openness: as many normals as positions are needed");
    check_argument(ray_count > 0, "ambient_openness: at least one ray a point is needed");
    std::vector<float> openness(positions_mm.size());
    const auto rays_a_point = static_cast<std::size_t>(ray_count);
    parallel_for(openness.size(), 64, [&](std::size_t begin, std::size_t end) {
        std::vector<TraceRay> rays(rays_a_point);
        std::vector<std::uint8_t> blocked(rays_a_point);
        for (std::size_t k = begin; k < end; ++k) {
            const glm::vec3 normal = normals[k];
            const glm::vec3 origin = offset_origin(positions_mm[k], normal);
            glm::vec3 s, t;
            make_basis(normal, s, t);
            const auto index = static_cast<std::uint32_t>(k);
            const double shift_u = hash_3d(index, 0, 1) * 0x1p-32;
            const double shift_v = hash_3d(index, 1, 1) * 0x1p-32;
            for (std::size_t r = 0; r < rays_a_point; ++r) {
                // A rank-1 lattice (golden ratio), shifted; projected disc = cosine-weighted sky.
                const auto i = static_cast<double>(r);
                const double u = std::fmod((i + shift_u) / ray_count, 1.0);
                const double v = std::fmod(i * (std::numbers::phi - 1.0) + shift_v, 1.0);
                const auto radius = LIVERY_MUTATED(openness, static_cast<float>(std::sqrt(u)));
                const auto height = static_cast<float>(std::sqrt(1.0 - u));
                const auto angle = static_cast<float>(2.0 * std::numbers::pi * v);
                rays[r] = {
                    origin,
                    0.0f,
                    radius * std::cos(angle) * s + radius * std::sin(angle) * t + height * normal,
                    max_distance_mm};
            }
            tracer.occluded(rays, blocked, RayOrder::scattered);
            std::size_t open = 0;
            for (const auto is_blocked : blocked) open += is_blocked ? 0 : 1;
            openness[k] = static_cast<float>(open) / static_cast<float>(ray_count);
        }
    });
    return openness;
}

}  // namespace livery
