#include "radiance/light/sky_visibility.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "appearance/bsdf_source.h"
#include "core/error.h"
#include "core/mutation.h"
#include "core/parallel.h"
#include "radiance/light/light_visibility.h"
#include "radiance/light/sphere_lookup.h"

namespace livery {
namespace {

double turn_of(std::size_t fragment, std::uint32_t purpose) {
    return turn_of_fragment_rad(fragment, purpose, 11u);
}

/// Cosine-weighted directions around a normal (Vogel's spiral on the projected disc).
class SkyDirections {
  public:
    explicit SkyDirections(int count) {
        for (int k = 0; k < count; ++k) {
            const double u = (k + 0.5) / count;
            const double angle = kGoldenAngle_rad * k;
            points_.emplace_back(
                std::sqrt(u) * std::cos(angle), std::sqrt(u) * std::sin(angle), std::sqrt(1.0 - u));
        }
    }

    std::size_t count() const { return points_.size(); }

    /// The spiral turned around the normal.
    void around(const glm::vec3& n, double turn_rad, std::span<glm::vec3> directions) const {
        turn_around(points_, n, basis_around(n), turn_rad, directions);
    }

  private:
    std::vector<glm::vec3> points_;  ///< around the z axis
};

/// Directions of a fragment that looks again: k-th from the sub-sample k % kSamplesAFragment.
void more_directions_of(const Mesh& mesh,
                        const SurfaceMap& map,
                        std::size_t fragment,
                        const SkyDirections& sky,
                        std::span<glm::vec3> directions) {
    std::vector<glm::vec3> around(directions.size());
    for (std::size_t s = 0; s < kSamplesAFragment; ++s) {
        sky.around(sample_normal(mesh, map, fragment, s), turn_of(fragment, 5u), around);
        for (std::size_t k = s; k < directions.size(); k += kSamplesAFragment) {
            directions[k] = around[k];
        }
    }
}

/// Whether light from the share of a few directions that is open may err by 15%: a standard error
/// of directions that know nothing of one another, which a spiral's are better than.
bool is_noisy(float open, int directions) {
    constexpr float kNoise = 0.15f;
    return 1.0f - open > kNoise * kNoise * open * static_cast<float>(directions);
}

/// Words of further directions of a fragment that is that share of its pixel: so many that its
/// pixel is no noisier than others.
std::uint32_t words_of(float coverage, const SkyRays& rays) {
    const float share = std::min(1.0f, 2.0f * coverage);
    const float wanted = static_cast<float>(rays.first + rays.more) * share;
    // A quarter of a word more or less makes no odds.
    const float words = (wanted - static_cast<float>(rays.first)) / 64.0f - 0.25f;
    return static_cast<std::uint32_t>(
        std::ceil(std::clamp(words, 0.0f, static_cast<float>(rays.more / 64))));
}

/// Directions of one to so many words of them.
class MoreDirections {
  public:
    explicit MoreDirections(int most) {
        for (int words = 1; words <= most / 64; ++words) of_words_.emplace_back(64 * words);
    }
    const SkyDirections& of(const SkyVisibility& visibility, std::size_t at) const {
        return of_words_[visibility.more_begin[at + 1] - visibility.more_begin[at] - 1];
    }

  private:
    std::vector<SkyDirections> of_words_;
};

/// Fills again, more_begin and more.
void look_again(const Mesh& mesh,
                const Tracer& tracer,
                const SurfaceMap& map,
                const Progress& progress,
                SkyVisibility& visibility) {
    visibility.more_begin = {0};
    for (std::size_t i = 0; i < visibility.blocked.size(); ++i) {
        const std::uint32_t words = words_of(map.fragments[i].coverage, visibility.rays);
        if (words == 0 || !is_noisy(visibility.openness(i), visibility.rays.first)) continue;
        visibility.again.push_back(static_cast<std::uint32_t>(i));
        visibility.more_begin.push_back(visibility.more_begin.back() + words);
    }
    const MoreDirections directions(visibility.rays.more);
    visibility.more.assign(visibility.more_begin.back(), 0);
    parallel_for(visibility.again.size(), 128, [&](std::size_t begin, std::size_t end) {
        progress.check_stop();
        std::vector<glm::vec3> toward;
        std::vector<TraceRay> rays;
        std::vector<std::uint8_t> blocked;
        std::array<glm::vec3, kSamplesAFragment> origins;
        for (std::size_t at = begin; at < end; ++at) {
            const std::size_t i = visibility.again[at];
            const SkyDirections& sky = directions.of(visibility, at);
            const std::size_t count = sky.count();
            toward.resize(count);
            rays.resize(count);
            blocked.resize(count);
            more_directions_of(mesh, map, i, sky, toward);
            ray_origins(mesh, map, i, origins);
            for (std::size_t k = 0; k < count; ++k) {
                rays[k].origin = origins[k % kSamplesAFragment];
                rays[k].direction = toward[k];
            }
            tracer.occluded(rays, blocked, RayOrder::scattered);
            std::uint64_t* words = &visibility.more[visibility.more_begin[at]];
            for (std::size_t k = 0; k < count; ++k) {
                if (blocked[k]) words[k / 64] |= std::uint64_t{1} << (k % 64);
            }
        }
    });
}

}  // namespace

glm::vec3 sample_normal(const Mesh& mesh,
                        const SurfaceMap& map,
                        std::size_t fragment,
                        std::size_t k) {
    const SurfaceSample& s = map.samples[fragment * kSamplesAFragment + k];
    const glm::uvec3 corners = mesh.triangles[s.triangle];
    const glm::vec3 normal = glm::normalize(
        (1.0f - s.barycentric.x - s.barycentric.y) * mesh.normals[corners.x] +
        s.barycentric.x * mesh.normals[corners.y] + s.barycentric.y * mesh.normals[corners.z]);
    const glm::vec3 mean = map.fragments[fragment].normal;
    if (map.flat_normals.empty()) return glm::dot(normal, mean) < 0.0f ? -normal : normal;
    // A relief turns all of a fragment's normals as it turns their mean
    const glm::vec3 flat = map.flat_normals[fragment];
    const glm::vec3 outward = glm::dot(normal, flat) < 0.0f ? -normal : normal;
    const glm::vec3 turn = glm::cross(flat, mean), turned = glm::cross(turn, outward);
    return glm::normalize(outward + turned +
                          glm::cross(turn, turned) / (1.0f + glm::dot(flat, mean)));
}

glm::vec3 toward_eye(const Fragment& fragment, glm::dvec3 eye_mm) {
    const auto wo = glm::vec3(glm::normalize(eye_mm - glm::dvec3(fragment.position_mm)));
    return f32::seen_from(wo, fragment.normal);
}

float SkyVisibility::openness(std::size_t fragment) const {
    return 1.0f -
           static_cast<float>(std::popcount(blocked[fragment])) / static_cast<float>(rays.first);
}

float SkyVisibility::openness_again(std::size_t at) const {
    int hidden = 0;
    const std::uint32_t begin = more_begin[at], end = more_begin[at + 1];
    for (std::uint32_t word = begin; word < end; ++word) hidden += std::popcount(more[word]);
    return 1.0f - static_cast<float>(hidden) / (64.0f * static_cast<float>(end - begin));
}

SkyVisibility solve_sky_visibility(const Mesh& mesh,
                                   const Tracer& tracer,
                                   const SurfaceMap& map,
                                   const SmoothRuns& runs,
                                   const SkyRays& sky_rays,
                                   const Progress& progress) {
    check_argument(
        sky_rays.first > 0 && sky_rays.first <= 64,
        fmt::format("{} sky directions a fragment, 1 to 64 are possible", sky_rays.first));
    check_argument(sky_rays.more >= 0 && sky_rays.more % 64 == 0,
                   fmt::format("{} more sky directions, no multiple of 64", sky_rays.more));
    SkyVisibility result;
    result.rays = sky_rays;
    result.blocked.assign(map.fragments.size(), 0);
    const SkyDirections sky(sky_rays.first);
    const auto look = [&](const auto& each) {
        progress.check_stop();
        const std::size_t count = sky.count();
        std::vector<glm::vec3> toward(count);
        std::vector<TraceRay> rays(count);
        std::vector<std::uint8_t> blocked(count);
        std::array<glm::vec3, kSamplesAFragment> origins;
        each([&](std::size_t i) {
            if (sky_rays.joints_only && map.fragments[i].coverage >= 1.0f) return;
            sky.around(map.fragments[i].normal, turn_of(i, 5u), toward);
            ray_origins(mesh, map, i, origins);
            for (std::size_t k = 0; k < count; ++k) {
                rays[k].origin = origins[k % kSamplesAFragment];
                rays[k].direction = toward[k];
            }
            tracer.occluded(rays, blocked, RayOrder::scattered);
            for (std::size_t k = 0; k < count; ++k) {
                if (blocked[k]) result.blocked[i] |= std::uint64_t{1} << k;
            }
        });
    };
    parallel_for(map.fragments.size(), 1024, [&](std::size_t begin, std::size_t end) {
        look([&](const auto& ask) { runs.ends(begin, end, ask); });
    });
    for (const SmoothRuns::Line line : SmoothRuns::kLines) {
        parallel_for(map.fragments.size(), 1024, [&](std::size_t begin, std::size_t end) {
            look([&](const auto& ask) {
                runs.between(line, begin, end, [&](std::size_t i, const SmoothRuns::Between& at) {
                    // Taken over from those that see less, their noise would show as dashes
                    if ((result.blocked[at.first] | result.blocked[at.second]) != 0) ask(i);
                });
            });
        });
    }
    if (sky_rays.more > 0) look_again(mesh, tracer, map, progress, result);
    return result;
}

std::vector<glm::vec3> sky_at_fragments(const Mesh& mesh,
                                        const SurfaceMap& map,
                                        const Environment& environment,
                                        const FilteredEnvironment& filtered,
                                        const SkyVisibility* visibility,
                                        Hidden by,
                                        const SmoothRuns& runs) {
    const auto scale = static_cast<float>(environment.scale);
    const SpherePlaces places(environment);
    const SphereStack diffuse({&filtered.diffuse, 1});
    const auto lookup = [&](const ImageF& light) {
        return visibility && by == Hidden::light ? SphereStack({&light, 1}) : SphereStack();
    };
    const SphereStack around_few = lookup(filtered.blurred);
    const SphereStack around_many = lookup(filtered.hardly_blurred);
    const auto open_sky = [&](const glm::vec3& n) {
        return LIVERY_MUTATED(sky_light, scale * rgb_of(diffuse.at(places.of(n)).in(0)));
    };
    // The same directions estimate the whole: the ratio is kinder to bright lamps
    const auto share_seen = [&](const SphereStack& light,
                                std::span<const glm::vec3> directions,
                                const std::uint64_t* words) {
        Texel hidden{}, seen{};
        for (std::size_t k = 0; k < directions.size(); ++k) {
            const bool blocked = ((words[k / 64] >> (k % 64)) & 1u) != 0;
            (blocked ? hidden : seen) += light.at(places.of(directions[k])).in(0);
        }
        return rgb_of(seen) / glm::max(rgb_of(hidden + seen), glm::vec3(1e-20f));
    };
    const SkyDirections sky(visibility ? visibility->rays.first : 0);
    const MoreDirections more(visibility ? visibility->rays.more : 0);
    std::vector<glm::vec3> result(map.fragments.size());
    parallel_for(result.size(), 1024, [&](std::size_t begin, std::size_t end) {
        runs.ends(
            begin, end, [&](std::size_t i) { result[i] = open_sky(map.fragments[i].normal); });
    });
    for (const SmoothRuns::Line line : SmoothRuns::kLines) {
        parallel_for(result.size(), 1024, [&](std::size_t begin, std::size_t end) {
            runs.between(line, begin, end, [&](std::size_t i, const SmoothRuns::Between& at) {
                result[i] = (1.0f - at.share) * result[at.first] + at.share * result[at.second];
            });
        });
    }
    if (!visibility) return result;
    if (by == Hidden::share) {
        parallel_for(result.size(), 4096, [&](std::size_t begin, std::size_t end) {
            const std::vector<std::uint32_t>& again = visibility->again;
            auto looked = std::lower_bound(again.begin(), again.end(), begin);
            for (std::size_t i = begin; i < end; ++i) {
                if (looked != again.end() && *looked == i) {
                    const auto at = static_cast<std::size_t>(looked++ - again.begin());
                    result[i] *= visibility->openness_again(at);
                } else if (visibility->blocked[i] != 0) {
                    result[i] *= visibility->openness(i);
                }
            }
        });
        return result;
    }
    parallel_for(result.size(), 1024, [&](std::size_t begin, std::size_t end) {
        std::vector<glm::vec3> directions(sky.count());
        for (std::size_t i = begin; i < end; ++i) {
            if (visibility->blocked[i] == 0) continue;
            sky.around(map.fragments[i].normal, turn_of(i, 5u), directions);
            result[i] *= share_seen(around_few, directions, &visibility->blocked[i]);
        }
    });
    // Who looked again knows better
    parallel_for(visibility->again.size(), 256, [&](std::size_t begin, std::size_t end) {
        std::vector<glm::vec3> directions;
        for (std::size_t at = begin; at < end; ++at) {
            const std::size_t i = visibility->again[at];
            const SkyDirections& around = more.of(*visibility, at);
            directions.resize(around.count());
            more_directions_of(mesh, map, i, around, directions);
            glm::vec3 light(0.0f);
            for (std::size_t k = 0; k < kSamplesAFragment; ++k) {
                light += open_sky(sample_normal(mesh, map, i, k));
            }
            result[i] =
                light / static_cast<float>(kSamplesAFragment) *
                share_seen(around_many, directions, &visibility->more[visibility->more_begin[at]]);
        }
    });
    return result;
}

}  // namespace livery
