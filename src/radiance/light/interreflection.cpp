#include "radiance/light/interreflection.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <optional>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "appearance/paint_bsdf.h"
#include "appearance/paint_figures.h"
#include "appearance/subsurface/scattering_medium.h"
#include "core/colour.h"
#include "core/error.h"
#include "core/parallel.h"
#include "core/random.h"
#include "radiance/light/light_visibility.h"
#include "radiance/light/sphere_lookup.h"
#include "radiance/light/spiral.h"
#include "scene/artwork_coats.h"

namespace livery {

namespace {

/// Rays in all, and of a node.
constexpr std::size_t kRays = 2'000'000;
constexpr int kFewestRays = 16, kMostRays = 64;

/// Light that is left of the first bounce's, below which no further one is followed.
constexpr float kNothingLeft = 1e-3f;

double turn_of(std::size_t node) { return turn_of_fragment_rad(node, 29u, 7u); }

std::vector<glm::vec3> cosine_directions(int count) {
    std::vector<glm::vec3> directions;
    for (int k = 0; k < count; ++k) {
        const double u = (k + 0.5) / count, angle = kGoldenAngle_rad * k;
        directions.emplace_back(
            std::sqrt(u) * std::cos(angle), std::sqrt(u) * std::sin(angle), std::sqrt(1.0 - u));
    }
    return directions;
}

/// One of the points around a hit, as often as that weighs.
std::uint32_t point_of(const Mesh& mesh,
                       const ExchangePoints& points,
                       const Hit& hit,
                       float chance) {
    const auto around = points.around(mesh, hit.triangle, hit.barycentric);
    for (const ExchangePoints::Share& share : around) {
        if (chance < share.weight) return share.index;
        chance -= share.weight;
    }
    return around.back().index;
}

float brightest(const glm::vec3& v) { return std::max({v.x, v.y, v.z}); }

}  // namespace

NodeExchange solve_node_exchange(const Mesh& mesh, const Tracer& tracer, const Progress& progress) {
    NodeExchange exchange;
    exchange.nodes = exchange_nodes(mesh);
    const ExchangeNodes& nodes = exchange.nodes;
    const std::size_t count = nodes.size();
    exchange.rays = std::clamp(
        static_cast<int>(kRays / std::max<std::size_t>(count, 1)), kFewestRays, kMostRays);
    exchange.blocked.assign(count, 0);
    exchange.first.assign(count + 1, 0);
    const auto spiral = cosine_directions(exchange.rays);

    constexpr std::size_t kAtATime = 256;
    std::vector<std::vector<std::uint32_t>> seen((count + kAtATime - 1) / kAtATime);
    parallel_for(seen.size(), 1, [&](std::size_t begin, std::size_t end) {
        progress.check_stop();
        std::vector<glm::vec3> directions(spiral.size());
        for (std::size_t block = begin; block < end; ++block) {
            const std::size_t past = std::min(count, (block + 1) * kAtATime);
            for (std::size_t i = block * kAtATime; i < past; ++i) {
                const glm::vec3 n = nodes.normal(i);
                turn_around(spiral, n, basis_around(n), turn_of(i), directions);
                TraceRay ray;
                ray.origin = nodes.ray_origin_mm(mesh, i);
                const std::size_t before = seen[block].size();
                for (std::size_t k = 0; k < directions.size(); ++k) {
                    ray.direction = directions[k];
                    const Hit hit = tracer.closest(ray);
                    if (!hit.valid()) continue;
                    exchange.blocked[i] |= std::uint64_t{1} << k;
                    const bool behind = sees_back(mesh, hit, ray.direction);
                    // The inside of a closed surface is dark.
                    if (behind && !has_two_sides(mesh, hit.triangle)) continue;
                    const auto chance = static_cast<float>(
                        hash_3d(static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(k), 31u) *
                        0x1p-32);
                    const std::uint32_t point = point_of(mesh, nodes.points, hit, chance);
                    seen[block].push_back(nodes.node_of[behind ? nodes.points.back[point] : point]);
                }
                exchange.first[i + 1] = static_cast<std::uint32_t>(seen[block].size() - before);
            }
        }
    });
    for (std::size_t i = 0; i < count; ++i) exchange.first[i + 1] += exchange.first[i];
    exchange.seen.reserve(exchange.first.back());
    for (const auto& some : seen) {
        exchange.seen.insert(exchange.seen.end(), some.begin(), some.end());
    }
    return exchange;
}

NodeExchange blocked_directions(const Mesh& mesh,
                                const Tracer& tracer,
                                ExchangeNodes nodes,
                                int rays,
                                const Progress& progress) {
    check_argument(rays >= 1 && rays <= kMostRays, "blocked_directions: 1 to 64 rays a node");
    NodeExchange exchange;
    exchange.nodes = std::move(nodes);
    exchange.rays = rays;
    exchange.blocked.assign(exchange.nodes.size(), 0);
    const auto spiral = cosine_directions(rays);
    parallel_for(exchange.nodes.size(), 256, [&](std::size_t begin, std::size_t end) {
        progress.check_stop();
        std::vector<glm::vec3> directions(spiral.size());
        for (std::size_t i = begin; i < end; ++i) {
            const glm::vec3 n = exchange.nodes.normal(i);
            turn_around(spiral, n, basis_around(n), turn_of(i), directions);
            TraceRay ray;
            ray.origin = exchange.nodes.ray_origin_mm(mesh, i);
            for (std::size_t k = 0; k < directions.size(); ++k) {
                ray.direction = directions[k];
                if (tracer.occluded(ray)) exchange.blocked[i] |= std::uint64_t{1} << k;
            }
        }
    });
    return exchange;
}

glm::vec3 entering_of_lamp(const EnteredMedium& medium, float cosine, float curvature_per_mm) {
    const auto enters =
        static_cast<float>(1.0 - dielectric_reflectance(static_cast<double>(cosine), medium.eta));
    // To first order: light that goes on for longer than the surface's radius knows nothing of it
    constexpr float kLargest = 0.25f;
    const glm::vec3 shift = glm::clamp(
        curvature_per_mm / static_cast<float>(medium.eta) * medium.path_mm, -kLargest, kLargest);
    return glm::max(
        cosine * enters * (1.0f - 2.0f * cosine * shift) + (1.0f - cosine * cosine) * shift,
        glm::vec3(0.0f));
}

float entering_share(double eta) {
    // What passes inward from everywhere passes outward from everywhere, over the index squared
    return static_cast<float>(2.0 * eta * eta * fresnel_moments(eta).passed[0]);
}

std::shared_ptr<const NodeExchange> SharedExchange::of(const Mesh& mesh,
                                                       const Tracer& tracer,
                                                       const Progress& progress) {
    const std::scoped_lock lock(mutex_);
    if (!made_) {
        made_ = std::make_shared<const NodeExchange>(solve_node_exchange(mesh, tracer, progress));
    }
    return made_;
}

std::vector<glm::vec3> direct_at_nodes(const Mesh& mesh,
                                       const Tracer& tracer,
                                       const NodeExchange& exchange,
                                       const std::vector<DirectionalLight>& lights,
                                       const Environment* environment,
                                       const FilteredEnvironment& filtered,
                                       const Progress& progress,
                                       const EnteredMedium* medium) {
    const ExchangeNodes& nodes = exchange.nodes;
    struct Lamp {
        glm::vec3 direction, radiance, radiance_rec709;
    };
    std::vector<Lamp> lamps;
    for (const DirectionalLight& light : lights) {
        lamps.push_back({glm::vec3(glm::normalize(light.direction)),
                         glm::vec3(working_from_rec709() * light.radiance_rec709),
                         glm::vec3(light.radiance_rec709)});
    }
    const auto spiral = cosine_directions(exchange.rays);
    const glm::mat3 working(working_from_rec709());
    std::optional<SpherePlaces> places;
    SphereStack diffuse, around;
    float scale = 0.0f;
    const float of_sky = medium ? entering_share(medium->eta) : 1.0f;
    if (environment) {
        places.emplace(*environment);
        diffuse = SphereStack({&filtered.diffuse, 1});
        around = SphereStack({&filtered.blurred, 1});
        scale = static_cast<float>(environment->scale);
    }
    const std::span origins(exchange.lamp_origins_mm);
    std::vector<glm::vec3> direct(nodes.size(), glm::vec3(0.0f));
    parallel_for(direct.size(), 512, [&](std::size_t begin, std::size_t end) {
        progress.check_stop();
        std::vector<glm::vec3> directions(spiral.size());
        for (std::size_t i = begin; i < end; ++i) {
            const glm::vec3 n = nodes.normal(i);
            for (std::size_t l = 0; l < lamps.size(); ++l) {
                const float cosine = glm::dot(n, lamps[l].direction);
                if (cosine <= 0.0f || lamps[l].radiance == glm::vec3(0.0f)) continue;
                const float open =
                    origins.empty()
                        ? disc_openness(
                              tracer, nodes.ray_origin_mm(mesh, i), n, lights[l], kLampRays, i)
                        : disc_openness(
                              tracer, origins.subspan(i * kLampRays, kLampRays), lights[l], i);
                direct[i] +=
                    open * (medium ? working * (lamps[l].radiance_rec709 *
                                                entering_of_lamp(
                                                    *medium, cosine, medium->curvature_per_mm[i]))
                                   : cosine * lamps[l].radiance);
            }
            if (!environment) continue;
            glm::vec3 sky = scale * of_sky * rgb_of(diffuse.at(places->of(n)).in(0));
            if (exchange.blocked[i] != 0) {
                // The same directions estimate the whole: the ratio is kinder to bright lamps
                turn_around(spiral, n, basis_around(n), turn_of(i), directions);
                Texel hidden{}, open{};
                for (std::size_t k = 0; k < directions.size(); ++k) {
                    const bool blocked = ((exchange.blocked[i] >> k) & 1u) != 0;
                    (blocked ? hidden : open) += around.at(places->of(directions[k])).in(0);
                }
                sky *= rgb_of(open) / glm::max(rgb_of(hidden + open), glm::vec3(1e-20f));
            }
            direct[i] += sky;
        }
    });
    return direct;
}

std::vector<glm::vec3> albedo_at_nodes(const Scene& scene, const ExchangeNodes& nodes) {
    std::vector<glm::vec3> of_part;
    for (const Material& material : scene.part_materials) {
        of_part.push_back(hemispherical_albedo(bsdf_of(material)));
    }
    std::vector<glm::vec3> albedo(nodes.size());
    for (std::size_t i = 0; i < albedo.size(); ++i) albedo[i] = of_part[nodes.part(i)];
    for (const PartArtwork& artwork : scene.artwork) {
        // Pictures are taken for their paint's own colour: of a decal the mean matters little
        const glm::vec3 over = hemispherical_albedo(bsdf_of(artwork.material));
        parallel_for(albedo.size(), 2048, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                if (nodes.part(i) != artwork.part) continue;
                const ArtworkPoint at = artwork_at(artwork,
                                                   glm::dvec3(nodes.position_mm(i)),
                                                   glm::dvec3(nodes.normal(i)),
                                                   glm::dvec2(nodes.points.uvs[nodes.point_of[i]]));
                albedo[i] = glm::mix(albedo[i], over, static_cast<float>(at.cover));
            }
        });
    }
    return albedo;
}

std::vector<glm::vec3> gathered_at_nodes(const NodeExchange& exchange,
                                         std::span<const glm::vec3> sent) {
    std::vector<glm::vec3> gathered(sent.size());
    const float share = 1.0f / static_cast<float>(exchange.rays);
    parallel_for(gathered.size(), 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            glm::vec3 sum(0.0f);
            for (std::size_t k = exchange.first[i]; k < exchange.first[i + 1]; ++k) {
                sum += sent[exchange.seen[k]];
            }
            gathered[i] = share * sum;
        }
    });
    return gathered;
}

ExchangedLight exchanged_at_nodes(const NodeExchange& exchange,
                                  std::span<const glm::vec3> direct,
                                  std::span<const glm::vec3> albedo,
                                  int bounces) {
    std::vector<glm::vec3> sent(direct.size()), sum(direct.size());
    for (std::size_t i = 0; i < sent.size(); ++i) sent[i] = albedo[i] * direct[i];
    float first = 0.0f;
    for (int bounce = 0; bounce < bounces; ++bounce) {
        const std::vector<glm::vec3> gathered = gathered_at_nodes(exchange, sent);
        float largest = 0.0f;
        for (std::size_t i = 0; i < sum.size(); ++i) {
            sum[i] += gathered[i];
            largest = std::max(largest, brightest(gathered[i]));
            sent[i] = albedo[i] * gathered[i];
        }
        if (bounce == 0) first = largest;
        if (largest <= kNothingLeft * first) break;
    }
    // Who looks at a node sees one bounce more than was followed
    for (std::size_t i = 0; i < sent.size(); ++i) sent[i] = albedo[i] * (direct[i] + sum[i]);
    return {std::move(sum), std::move(sent)};
}

std::vector<glm::vec3> at_fragments(const Mesh& mesh,
                                    const SurfaceMap& map,
                                    const ExchangeNodes& nodes,
                                    const std::vector<glm::vec3>& at_nodes,
                                    std::span<const std::uint32_t> place_of,
                                    std::span<const std::uint32_t> behind_of) {
    const ExchangePoints& points = nodes.points;
    const std::vector<glm::vec3> at_points = nodes.at_points(at_nodes);
    std::vector<glm::vec3> result(map.fragments.size(), glm::vec3(0.0f));
    parallel_for(map.fragments.size(), 2048, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const glm::vec3 normal = map.fragments[i].normal;
            float weight = 0.0f;
            const auto add = [&](std::uint32_t triangle, const glm::vec2& barycentric) {
                if (triangle == kNoTriangle) return;
                for (const auto& share : points.around(mesh, triangle, barycentric)) {
                    const std::uint32_t seen = points.on_side(share.index, normal);
                    if (seen == ExchangePoints::kNoBack) continue;
                    result[i] += share.weight * at_points[seen];
                    weight += share.weight;
                }
            };
            for (std::size_t s = 0; s < kSamplesAFragment; ++s) {
                const SurfaceSample& sample = map.samples[i * kSamplesAFragment + s];
                add(place_of.empty() ? sample.triangle : place_of[sample.triangle],
                    sample.barycentric);
                if (!behind_of.empty()) add(behind_of[sample.triangle], sample.barycentric);
            }
            if (weight > 0.0f) result[i] /= weight;
        }
    });
    return result;
}

}  // namespace livery
