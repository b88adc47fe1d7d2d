#include "radiance/light/light_visibility.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "core/error.h"
#include "core/parallel.h"
#include "radiance/light/sphere_lookup.h"

namespace livery {
namespace {

/// Unit directions to points of a light's disc, equal solid angles (Vogel's spiral on the cap).
class DiscDirections {
  public:
    DiscDirections(const glm::vec3& centre, double one_minus_cos, std::size_t count)
        : centre_(centre), basis_(basis_around(centre)) {
        for (std::size_t k = 0; k < count; ++k) {
            const double down =
                one_minus_cos * (static_cast<double>(k) + 0.5) / static_cast<double>(count);
            const double radius = std::sqrt(down * (2.0 - down));
            const double angle = kGoldenAngle_rad * static_cast<double>(k);
            points_.emplace_back(radius * std::cos(angle), radius * std::sin(angle), 1.0 - down);
        }
    }

    std::size_t count() const { return points_.size(); }

    /// The spiral turned around the disc's centre.
    void turned(double turn_rad, std::span<glm::vec3> directions) const {
        turn_around(points_, centre_, basis_, turn_rad, directions);
    }

  private:
    glm::vec3 centre_;
    Basis basis_;
    std::vector<glm::vec3> points_;  ///< around the z axis
};

/// 1 - cos of the disc's half-angle.
double cap_of(const DirectionalLight& light) {
    return 2.0 * std::pow(std::sin(0.25 * light.angle_rad), 2.0);
}

double turn_of_seed(std::size_t seed) { return turn_of_fragment_rad(seed, 17u, 3u); }

/// Sums up what is seen of the light from one fragment.
LightAtFragment summarise(const glm::vec3& normal,
                          const glm::vec3& centre,
                          std::span<const glm::vec3> directions,
                          std::span<const std::uint8_t> blocked) {
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
    const std::vector<glm::vec3> origins(
        static_cast<std::size_t>(light.angle_rad > 0.0 ? ray_count : 1),
        offset_origin(position_mm, normal));
    return disc_openness(tracer, origins, light, seed);
}

float disc_openness(const Tracer& tracer,
                    std::span<const glm::vec3> origins_mm,
                    const DirectionalLight& light,
                    std::size_t seed) {
    const glm::vec3 centre(glm::normalize(light.direction));
    std::vector<glm::vec3> directions(origins_mm.size(), centre);
    if (light.angle_rad > 0.0) {
        DiscDirections(centre, cap_of(light), directions.size())
            .turned(turn_of_seed(seed), directions);
    }
    int open = 0;
    for (std::size_t k = 0; k < directions.size(); ++k) {
        TraceRay ray;
        ray.origin = origins_mm[k];
        ray.direction = directions[k];
        if (!tracer.occluded(ray)) ++open;
    }
    return static_cast<float>(open) / static_cast<float>(directions.size());
}

void ray_origins(const Mesh& mesh,
                 const SurfaceMap& map,
                 std::size_t fragment,
                 std::span<glm::vec3> origins) {
    const SurfaceSample* sample = &map.samples[fragment * kSamplesAFragment];
    for (std::size_t k = 0; k < origins.size(); ++k, ++sample) {
        const glm::uvec3 corners = mesh.triangles[sample->triangle];
        const glm::vec3 a = mesh.positions_mm[corners.x];
        const glm::vec3 ab = mesh.positions_mm[corners.y] - a;
        const glm::vec3 ac = mesh.positions_mm[corners.z] - a;
        glm::vec3 outward = glm::normalize(glm::cross(ab, ac));
        if (glm::dot(outward, map.fragments[fragment].normal) < 0.0f) outward = -outward;
        origins[k] =
            offset_origin(a + sample->barycentric.x * ab + sample->barycentric.y * ac, outward);
    }
}

std::vector<LightAtFragment> light_at_fragments(const Mesh& mesh,
                                                const Tracer& tracer,
                                                const SurfaceMap& map,
                                                const SmoothRuns& runs,
                                                const DirectionalLight& light,
                                                int rays_per_fragment,
                                                const Progress& progress) {
    check_argument(rays_per_fragment > 0,
                   fmt::format("{} shadow rays a fragment", rays_per_fragment));
    const glm::vec3 centre(glm::normalize(light.direction));
    const bool point = light.angle_rad <= 0.0 || rays_per_fragment == 1;
    const std::size_t ray_count =
        point ? std::min(kSamplesAFragment, static_cast<std::size_t>(rays_per_fragment))
              : static_cast<std::size_t>(rays_per_fragment);
    const DiscDirections disc(centre, cap_of(light), ray_count);
    const auto lowest = static_cast<float>(point ? 0.0 : -std::sin(0.5 * light.angle_rad));

    // Rays of several fragments at a time, so that none of a packet's lanes stays empty
    constexpr std::size_t kAtATime = 512;
    const std::size_t together = std::max<std::size_t>(kAtATime / ray_count, 1);
    std::vector<LightAtFragment> result(map.fragments.size());
    // Of the fragments that `each` hands on
    const auto trace = [&](const auto& each) {
        progress.check_stop();
        std::vector<glm::vec3> directions(together * ray_count, centre);
        std::vector<TraceRay> rays(directions.size());
        std::vector<std::uint8_t> blocked(rays.size());
        std::vector<std::size_t> waiting;
        std::array<glm::vec3, kSamplesAFragment> origins;
        const auto answer = [&] {
            const std::size_t count = waiting.size() * ray_count;
            tracer.occluded(std::span(rays).first(count), std::span(blocked).first(count));
            for (std::size_t w = 0; w < waiting.size(); ++w) {
                const std::size_t at = w * ray_count;
                result[waiting[w]] = summarise(map.fragments[waiting[w]].normal,
                                               centre,
                                               std::span(directions).subspan(at, ray_count),
                                               std::span(blocked).subspan(at, ray_count));
            }
            waiting.clear();
        };
        each([&](std::size_t i) {
            result[i].direction = centre;
            if (glm::dot(map.fragments[i].normal, centre) <= lowest) return;
            const std::size_t at = waiting.size() * ray_count;
            if (!point) disc.turned(turn_of_seed(i), std::span(directions).subspan(at, ray_count));
            const std::size_t own = std::min(ray_count, kSamplesAFragment);
            ray_origins(mesh, map, i, std::span(origins).first(own));
            for (std::size_t k = 0; k < ray_count; ++k) {
                rays[at + k].origin = origins[k % kSamplesAFragment];
                rays[at + k].direction = directions[at + k];
            }
            waiting.push_back(i);
            if (waiting.size() == together) answer();
        });
        answer();
    };
    parallel_for(result.size(), 1024, [&](std::size_t begin, std::size_t end) {
        trace([&](const auto& ask) { runs.ends(begin, end, ask); });
    });
    for (const SmoothRuns::Line line : SmoothRuns::kLines) {
        parallel_for(result.size(), 1024, [&](std::size_t begin, std::size_t end) {
            trace([&](const auto& ask) {
                runs.between(line, begin, end, [&](std::size_t i, const SmoothRuns::Between& at) {
                    const float first = result[at.first].visibility;
                    const bool whole = first == 0.0f || first == 1.0f;
                    if (!whole || result[at.second].visibility != first) return ask(i);
                    result[i] = {centre, first};
                });
            });
        });
    }
    return result;
}

std::vector<LightAtFragment> unhidden_light(const SurfaceMap& map, const DirectionalLight& light) {
    const glm::vec3 centre(glm::normalize(light.direction));
    return std::vector<LightAtFragment>(map.fragments.size(), LightAtFragment{centre, 1.0f});
}

}  // namespace livery
