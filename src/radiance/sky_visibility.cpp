#include "radiance/sky_visibility.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "core/error.h"
#include "core/parallel.h"
#include "core/random.h"
#include "radiance/light_visibility.h"

namespace livery {
namespace {

constexpr double kGoldenAngle = std::numbers::pi * 0.76393202250021030;

double turn_of(std::size_t fragment, std::uint32_t purpose) {
    return 2.0 * std::numbers::pi *
           (hash_3d(static_cast<std::uint32_t>(fragment), purpose, 11u) * 0x1p-32);
}

/// k-th of `count` cosine-weighted directions around `n` (Vogel's spiral on the projected disc).
glm::vec3 sky_direction(const glm::vec3& n, const Basis& basis, int k, int count, double turn) {
    const double u = (k + 0.5) / count;
    const double angle = turn + kGoldenAngle * k;
    const auto x = static_cast<float>(std::sqrt(u) * std::cos(angle));
    const auto y = static_cast<float>(std::sqrt(u) * std::sin(angle));
    return x * basis.s + y * basis.t + static_cast<float>(std::sqrt(1.0 - u)) * n;
}

}  // namespace

glm::vec3 toward_eye(const Fragment& fragment, glm::dvec3 eye_mm) {
    constexpr float kLowest = 1e-4f;
    const glm::vec3 n = fragment.normal;
    const auto wo = glm::vec3(glm::normalize(eye_mm - glm::dvec3(fragment.position_mm)));
    const float cosine = glm::dot(n, wo);
    if (cosine >= kLowest) return wo;
    return glm::normalize(wo + (kLowest - cosine) * n);
}

SkyVisibility solve_sky_visibility(const Mesh& mesh,
                                   const Tracer& tracer,
                                   const SurfaceMap& map,
                                   int directions,
                                   const Progress& progress) {
    check_argument(directions > 0 && directions <= 64,
                   fmt::format("{} sky directions a fragment, 1 to 64 are possible", directions));
    SkyVisibility result;
    result.directions = directions;
    result.blocked.assign(map.fragments.size(), 0);
    parallel_for(map.fragments.size(), 1024, [&](std::size_t begin, std::size_t end) {
        progress.check_stop();
        const auto count = static_cast<std::size_t>(directions);
        std::vector<TraceRay> rays(count);
        std::vector<std::uint8_t> blocked(count);
        for (std::size_t i = begin; i < end; ++i) {
            const glm::vec3 n = map.fragments[i].normal;
            const Basis basis = basis_around(n);
            const double turn = turn_of(i, 5u);
            for (std::size_t k = 0; k < count; ++k) {
                rays[k].origin = ray_origin(mesh, map, i, k % kSamplesAFragment);
                rays[k].direction = sky_direction(n, basis, static_cast<int>(k), directions, turn);
            }
            tracer.occluded(rays, blocked);
            for (std::size_t k = 0; k < count; ++k) {
                if (blocked[k]) result.blocked[i] |= std::uint64_t{1} << k;
            }
        }
    });
    return result;
}

std::vector<glm::vec3> sky_at_fragments(const SurfaceMap& map,
                                        const Environment& environment,
                                        const FilteredEnvironment& filtered,
                                        const SkyVisibility* visibility) {
    const auto scale = static_cast<float>(environment.scale);
    std::vector<glm::vec3> result(map.fragments.size());
    parallel_for(result.size(), 1024, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const glm::vec3 n = map.fragments[i].normal;
            const auto at = [&](const ImageF& picture, const glm::vec3& direction) {
                return sample_sphere(picture,
                                     uv_from_direction(environment, glm::dvec3(direction)));
            };
            glm::vec3 light = at(filtered.diffuse, n);
            if (visibility && visibility->blocked[i]) {
                const Basis basis = basis_around(n);
                const double turn = turn_of(i, 5u);
                glm::vec3 hidden(0.0f), seen(0.0f);
                for (int k = 0; k < visibility->directions; ++k) {
                    const glm::vec3 radiance = at(
                        filtered.blurred, sky_direction(n, basis, k, visibility->directions, turn));
                    ((visibility->blocked[i] >> k) & 1u ? hidden : seen) += radiance;
                }
                // The same directions estimate the whole: the ratio is kinder to bright lamps
                light *= seen / glm::max(hidden + seen, glm::vec3(1e-20f));
            }
            result[i] = scale * light;
        }
    });
    return result;
}

std::vector<glm::vec3> solve_mirror_openness(const Mesh& mesh,
                                             const Tracer& tracer,
                                             const SurfaceMap& map,
                                             glm::dvec3 eye_mm,
                                             int rays_a_lobe,
                                             const Progress& progress) {
    check_argument(rays_a_lobe > 0, fmt::format("{} rays a lobe", rays_a_lobe));
    std::vector<glm::vec3> result(map.fragments.size());
    parallel_for(map.fragments.size(), 512, [&](std::size_t begin, std::size_t end) {
        progress.check_stop();
        std::vector<TraceRay> rays;
        std::vector<std::uint8_t> blocked;
        for (std::size_t i = begin; i < end; ++i) {
            const Fragment& fragment = map.fragments[i];
            const glm::vec3 n = fragment.normal;
            const glm::vec3 wo = toward_eye(fragment, eye_mm);
            const Basis basis = basis_around(n);
            const double turn = turn_of(i, 7u);
            rays.clear();
            std::array<std::size_t, kMirrorAlphas.size() + 1> first{};
            for (std::size_t lobe = 0; lobe < kMirrorAlphas.size(); ++lobe) {
                for (int k = 0; k < rays_a_lobe; ++k) {
                    const double u = (k + 0.5) / rays_a_lobe;
                    const double slope = kMirrorAlphas[lobe] * std::sqrt(u / (1.0 - u));
                    const double angle = turn + kGoldenAngle * k;
                    const glm::vec3 h =
                        glm::normalize(n + static_cast<float>(slope * std::cos(angle)) * basis.s +
                                       static_cast<float>(slope * std::sin(angle)) * basis.t);
                    const glm::vec3 wi = 2.0f * glm::dot(wo, h) * h - wo;
                    if (glm::dot(wi, n) <= 0.0f) continue;
                    TraceRay& ray = rays.emplace_back();
                    ray.origin =
                        ray_origin(mesh, map, i, static_cast<std::size_t>(k) % kSamplesAFragment);
                    ray.direction = wi;
                }
                first[lobe + 1] = rays.size();
            }
            blocked.resize(rays.size());
            tracer.occluded(rays, blocked);
            for (std::size_t lobe = 0; lobe < kMirrorAlphas.size(); ++lobe) {
                const auto count = static_cast<float>(first[lobe + 1] - first[lobe]);
                float open = 0.0f;
                for (std::size_t k = first[lobe]; k < first[lobe + 1]; ++k) {
                    if (!blocked[k]) open += 1.0f;
                }
                result[i][static_cast<int>(lobe)] = count > 0.0f ? open / count : 1.0f;
            }
        }
    });
    return result;
}

}  // namespace livery
