#include "radiance/light_visibility.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "core/error.h"
#include "core/parallel.h"
#include "core/random.h"

namespace livery {
namespace {

/// Unit directions to points of the light's disc, equal solid angles (Vogel's spiral on the cap),
/// turned by `turn_rad`.
void sample_disc(const glm::vec3& centre,
                 const Basis& basis,
                 double one_minus_cos,
                 double turn_rad,
                 std::vector<glm::vec3>& directions) {
    const double count = static_cast<double>(directions.size());
    constexpr double kGoldenAngle = std::numbers::pi * 0.76393202250021030;
    for (std::size_t k = 0; k < directions.size(); ++k) {
        const double down = one_minus_cos * (static_cast<double>(k) + 0.5) / count;
        const auto height = static_cast<float>(1.0 - down);
        const auto radius = static_cast<float>(std::sqrt(down * (2.0 - down)));
        const double angle = turn_rad + kGoldenAngle * static_cast<double>(k);
        directions[k] = height * centre + radius * (static_cast<float>(std::cos(angle)) * basis.s +
                                                    static_cast<float>(std::sin(angle)) * basis.t);
    }
}

/// 1 - cos of the disc's half-angle.
double cap_of(const DirectionalLight& light) {
    return 2.0 * std::pow(std::sin(0.25 * light.angle_rad), 2.0);
}

double turn_of(std::size_t seed) {
    return 2.0 * std::numbers::pi * (hash_3d(static_cast<std::uint32_t>(seed), 17u, 3u) * 0x1p-32);
}

/// Sums up what is seen of the light from one fragment.
LightAtFragment summarise(const glm::vec3& normal,
                          const glm::vec3& centre,
                          const std::vector<glm::vec3>& directions,
                          const std::vector<std::uint8_t>& blocked) {
    glm::vec3 sum(0.0f);
    float cosines = 0.0f;
    bool all = true;
    for (std::size_t k = 0; k < directions.size(); ++k) {
        const float cosine = glm::dot(normal, directions[k]);
        if (blocked[k] || cosine <= 0.0f) {
            all = false;
            continue;
        }
        cosines += cosine;
        sum += cosine * directions[k];
    }
    if (all) return {centre, 1.0f};
    if (cosines <= 0.0f) return {centre, 0.0f};
    const glm::vec3 direction = glm::normalize(sum);
    const float cosine = std::max(glm::dot(normal, direction), 1e-6f);
    return {direction, cosines / (static_cast<float>(directions.size()) * cosine)};
}

}  // namespace

float disc_openness(const Tracer& tracer,
                    const glm::vec3& position_mm,
                    const glm::vec3& normal,
                    const DirectionalLight& light,
                    int ray_count,
                    std::size_t seed) {
    const glm::vec3 centre(glm::normalize(light.direction));
    std::vector<glm::vec3> directions(
        static_cast<std::size_t>(light.angle_rad > 0.0 ? ray_count : 1), centre);
    if (light.angle_rad > 0.0) {
        sample_disc(centre, basis_around(centre), cap_of(light), turn_of(seed), directions);
    }
    int open = 0;
    for (const glm::vec3& direction : directions) {
        TraceRay ray;
        ray.origin = offset_origin(position_mm, normal);
        ray.direction = direction;
        if (!tracer.occluded(ray)) ++open;
    }
    return static_cast<float>(open) / static_cast<float>(directions.size());
}

Basis basis_around(const glm::vec3& n) {
    const float sign = std::copysign(1.0f, n.z);
    const float a = -1.0f / (sign + n.z);
    const float b = n.x * n.y * a;
    return {{1.0f + sign * n.x * n.x * a, sign * b, -sign * n.x}, {b, sign + n.y * n.y * a, -n.y}};
}

glm::vec3 ray_origin(const Mesh& mesh, const SurfaceMap& map, std::size_t fragment, std::size_t k) {
    const SurfaceSample& s = map.samples[fragment * kSamplesAFragment + k];
    const glm::uvec3 corners = mesh.triangles[s.triangle];
    const glm::vec3 a = mesh.positions_mm[corners.x];
    const glm::vec3 ab = mesh.positions_mm[corners.y] - a;
    const glm::vec3 ac = mesh.positions_mm[corners.z] - a;
    glm::vec3 outward = glm::normalize(glm::cross(ab, ac));
    if (glm::dot(outward, map.fragments[fragment].normal) < 0.0f) outward = -outward;
    return offset_origin(a + s.barycentric.x * ab + s.barycentric.y * ac, outward);
}

std::vector<LightAtFragment> light_at_fragments(const Mesh& mesh,
                                                const Tracer& tracer,
                                                const SurfaceMap& map,
                                                const DirectionalLight& light,
                                                int rays_per_fragment,
                                                const Progress& progress) {
    check_argument(rays_per_fragment > 0,
                   fmt::format("{} shadow rays a fragment", rays_per_fragment));
    const glm::vec3 centre(glm::normalize(light.direction));
    const Basis basis = basis_around(centre);
    const bool point = light.angle_rad <= 0.0 || rays_per_fragment == 1;
    const std::size_t ray_count =
        point ? std::min(kSamplesAFragment, static_cast<std::size_t>(rays_per_fragment))
              : static_cast<std::size_t>(rays_per_fragment);
    const auto lowest = static_cast<float>(point ? 0.0 : -std::sin(0.5 * light.angle_rad));

    std::vector<LightAtFragment> result(map.fragments.size());
    parallel_for(result.size(), 1024, [&](std::size_t begin, std::size_t end) {
        progress.check_stop();
        std::vector<glm::vec3> directions(ray_count, centre);
        std::vector<TraceRay> rays(ray_count);
        std::vector<std::uint8_t> blocked(ray_count);
        for (std::size_t i = begin; i < end; ++i) {
            const glm::vec3 normal = map.fragments[i].normal;
            result[i].direction = centre;
            if (glm::dot(normal, centre) <= lowest) continue;
            if (!point) {
                sample_disc(centre, basis, cap_of(light), turn_of(i), directions);
            }
            for (std::size_t k = 0; k < ray_count; ++k) {
                rays[k].origin = ray_origin(mesh, map, i, k % kSamplesAFragment);
                rays[k].direction = directions[k];
            }
            tracer.occluded(rays, blocked);
            result[i] = summarise(normal, centre, directions, blocked);
        }
    });
    return result;
}

}  // namespace livery
