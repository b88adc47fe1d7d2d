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
#include "scene/artwork_coats.h"

namespace livery {

namespace {

/// Rays in all, and of a node.
constexpr std::size_t kRays = 2'000'000;
constexpr int kFewestRays = 16;

/// Light that is left of the first bounce's, below which no further one is followed.
constexpr float kNothingLeft = 1e-3f;

/// By a node's place: neither the order of nodes nor the side that is called the front changes what
/// its rays meet.
std::uint32_t seed_of(const ExchangeNodes& nodes, std::size_t node) {
    const glm::vec3 at = nodes.position_mm(node);
    return hash_3d(std::bit_cast<std::uint32_t>(at.x),
                   std::bit_cast<std::uint32_t>(at.y),
                   std::bit_cast<std::uint32_t>(at.z));
}

std::vector<glm::vec3> x_axes_of(const ExchangeNodes& nodes) {
    std::vector<glm::vec3> axes(nodes.size());
    constexpr glm::vec3 kX(1.0f, 0.0f, 0.0f);
    for (std::size_t i = 0; i < axes.size(); ++i) {
        const glm::vec3 n = nodes.normal(i);
        const double turn = turn_of_fragment_rad(seed_of(nodes, i), 29u, 7u);
        turn_around({&kX, 1}, n, basis_around(n), turn, {&axes[i], 1});
    }
    return axes;
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

float brightest_of(std::span<const glm::vec3> all) {
    float most = 0.0f;
    for (const glm::vec3& one : all) most = std::max(most, brightest(one));
    return most;
}

/// A lamp's light among rays: as if it were as wide as they are apart. `turned` are directions, of
/// which each stands for as much of a diffuser's light.
void add_lamp(const glm::vec3& lamp,
              const glm::vec3& on_diffuser,
              std::span<const glm::vec3> turned,
              std::span<glm::vec3> along) {
    const auto count = static_cast<float>(turned.size());
    std::array<float, kMostNodeRays> weights{};
    float sum = 0.0f;
    for (std::size_t k = 0; k < turned.size(); ++k) {
        sum += weights[k] = share_of_ray(lamp - turned[k], turned.size());
    }
    if (!(sum > 0.0f)) {
        // Beyond the rays that are nearest to the horizon
        const auto nearest =
            std::max_element(turned.begin(), turned.end(), [&](const auto& a, const auto& b) {
                return glm::dot(a, lamp) < glm::dot(b, lamp);
            });
        weights[static_cast<std::size_t>(nearest - turned.begin())] = sum = 1.0f;
    }
    for (std::size_t k = 0; k < turned.size(); ++k) {
        along[k] += count * weights[k] / sum * on_diffuser;
    }
}

}  // namespace

void NodeExchange::directions_of(std::size_t node, std::span<glm::vec3> turned) const {
    const glm::vec3 x = x_axes[node], z = nodes.normal(node), y = glm::cross(z, x);
    const std::span<const glm::vec3> all = directions.directions();
    for (std::size_t k = 0; k < all.size(); ++k) {
        turned[k] = all[k].x * x + all[k].y * y + all[k].z * z;
    }
}

std::uint32_t NodeExchange::ray_toward(std::uint32_t node,
                                       const glm::vec3& toward,
                                       const glm::vec3& normal) const {
    const glm::vec3 x = x_axes[node], z = nodes.normal(node), y = glm::cross(z, x);
    const glm::vec3 mirrored = 2.0f * glm::dot(normal, toward) * normal - toward;
    // In the node's frame, whose own mirror turns that back
    const glm::vec3 own(-glm::dot(x, mirrored), -glm::dot(y, mirrored), glm::dot(z, mirrored));
    return ray_of_node(node, directions.nearest(own));
}

NodeExchange solve_node_exchange(const Mesh& mesh, const Tracer& tracer, const Progress& progress) {
    NodeExchange exchange;
    exchange.nodes = exchange_nodes(mesh);
    const ExchangeNodes& nodes = exchange.nodes;
    const std::size_t count = nodes.size();
    exchange.directions = NodeDirections(std::clamp(
        static_cast<int>(kRays / std::max<std::size_t>(count, 1)), kFewestRays, kMostNodeRays));
    exchange.x_axes = x_axes_of(nodes);
    exchange.blocked.assign(count, 0);
    exchange.first.assign(count + 1, 0);

    constexpr std::size_t kAtATime = 256;
    struct Seen {
        std::vector<std::uint8_t> by;
        std::vector<std::uint32_t> rays;
    };
    std::vector<Seen> seen((count + kAtATime - 1) / kAtATime);
    parallel_for(seen.size(), 1, [&](std::size_t begin, std::size_t end) {
        progress.check_stop();
        std::vector<glm::vec3> directions(exchange.rays());
        for (std::size_t block = begin; block < end; ++block) {
            const std::size_t past = std::min(count, (block + 1) * kAtATime);
            for (std::size_t i = block * kAtATime; i < past; ++i) {
                exchange.directions_of(i, directions);
                const std::uint32_t seed = seed_of(nodes, i);
                TraceRay ray;
                ray.origin = nodes.ray_origin_mm(mesh, i);
                const std::size_t before = seen[block].by.size();
                for (std::size_t k = 0; k < directions.size(); ++k) {
                    ray.direction = directions[k];
                    const Hit hit = tracer.closest(ray);
                    if (!hit.valid()) continue;
                    exchange.blocked[i] |= std::uint64_t{1} << k;
                    const bool behind = sees_back(mesh, hit, ray.direction);
                    // The inside of a closed surface is dark.
                    if (behind && !has_two_sides(mesh, hit.triangle)) continue;
                    const auto chance = static_cast<float>(
                        hash_3d(seed, static_cast<std::uint32_t>(k), 31u) * 0x1p-32);
                    const std::uint32_t point = point_of(mesh, nodes.points, hit, chance);
                    const std::uint32_t node =
                        nodes.node_of[behind ? nodes.points.back[point] : point];
                    const glm::vec3 normal = shading_normal(mesh, hit);
                    seen[block].by.push_back(static_cast<std::uint8_t>(k));
                    seen[block].rays.push_back(
                        exchange.ray_toward(node, -ray.direction, behind ? -normal : normal));
                }
                exchange.first[i + 1] = static_cast<std::uint32_t>(seen[block].by.size() - before);
            }
        }
    });
    for (std::size_t i = 0; i < count; ++i) exchange.first[i + 1] += exchange.first[i];
    exchange.by.reserve(exchange.first.back());
    exchange.seen.reserve(exchange.first.back());
    for (const Seen& some : seen) {
        exchange.by.insert(exchange.by.end(), some.by.begin(), some.by.end());
        exchange.seen.insert(exchange.seen.end(), some.rays.begin(), some.rays.end());
    }
    return exchange;
}

NodeExchange blocked_directions(const Mesh& mesh,
                                const Tracer& tracer,
                                ExchangeNodes nodes,
                                int rays,
                                const Progress& progress) {
    check_argument(rays >= 1 && rays <= kMostNodeRays, "blocked_directions: 1 to 64 rays a node");
    NodeExchange exchange;
    exchange.nodes = std::move(nodes);
    exchange.directions = NodeDirections(rays);
    exchange.x_axes = x_axes_of(exchange.nodes);
    exchange.blocked.assign(exchange.nodes.size(), 0);
    parallel_for(exchange.nodes.size(), 256, [&](std::size_t begin, std::size_t end) {
        progress.check_stop();
        std::vector<glm::vec3> directions(exchange.rays());
        for (std::size_t i = begin; i < end; ++i) {
            exchange.directions_of(i, directions);
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
                                       const EnteredMedium* medium,
                                       NodeLight* along) {
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
        std::vector<glm::vec3> directions(exchange.rays());
        std::vector<glm::vec3> skies(exchange.rays());
        for (std::size_t i = begin; i < end; ++i) {
            const glm::vec3 n = nodes.normal(i);
            const bool by_ray = along && along->by_ray(i);
            const std::uint32_t seed = seed_of(nodes, i);
            if (by_ray || (environment && exchange.blocked[i] != 0)) {
                exchange.directions_of(i, directions);
            }
            for (std::size_t l = 0; l < lamps.size(); ++l) {
                const float cosine = glm::dot(n, lamps[l].direction);
                if (cosine <= 0.0f || lamps[l].radiance == glm::vec3(0.0f)) continue;
                const float open =
                    origins.empty()
                        ? disc_openness(
                              tracer, nodes.ray_origin_mm(mesh, i), n, lights[l], kLampRays, seed)
                        : disc_openness(
                              tracer, origins.subspan(i * kLampRays, kLampRays), lights[l], seed);
                const glm::vec3 light =
                    open * (medium ? working * (lamps[l].radiance_rec709 *
                                                entering_of_lamp(
                                                    *medium, cosine, medium->curvature_per_mm[i]))
                                   : cosine * lamps[l].radiance);
                direct[i] += light;
                if (by_ray) add_lamp(lamps[l].direction, light, directions, along->of(i));
            }
            if (!environment) continue;
            glm::vec3 sky = scale * of_sky * rgb_of(diffuse.at(places->of(n)).in(0));
            if (exchange.blocked[i] != 0 || by_ray) {
                // The same directions estimate the whole: the ratio is kinder to bright lamps
                glm::vec3 hidden(0.0f), open(0.0f);
                for (std::size_t k = 0; k < directions.size(); ++k) {
                    const bool blocked = ((exchange.blocked[i] >> k) & 1u) != 0;
                    skies[k] = rgb_of(around.at(places->of(directions[k])).in(0));
                    (blocked ? hidden : open) += skies[k];
                    if (blocked) skies[k] = glm::vec3(0.0f);
                }
                const glm::vec3 whole = glm::max(hidden + open, glm::vec3(1e-20f));
                if (by_ray) {
                    const glm::vec3 unit = static_cast<float>(directions.size()) * sky / whole;
                    const std::span<glm::vec3> own = along->of(i);
                    for (std::size_t k = 0; k < own.size(); ++k) own[k] += unit * skies[k];
                }
                sky *= open / whole;
            }
            direct[i] += sky;
        }
    });
    return direct;
}

DirectLight direct_light_at_nodes(const Mesh& mesh,
                                  const Tracer& tracer,
                                  const NodeExchange& exchange,
                                  const std::vector<DirectionalLight>& lights,
                                  const Environment* environment,
                                  const FilteredEnvironment& filtered,
                                  const std::vector<bool>& lobes,
                                  const Progress& progress) {
    DirectLight direct;
    direct.along = dark_nodes(exchange.nodes, lobes, exchange.rays());
    direct.on_diffuser = direct_at_nodes(
        mesh, tracer, exchange, lights, environment, filtered, progress, nullptr, &direct.along);
    return direct;
}

std::vector<glm::vec3> gathered_at_nodes(const NodeExchange& exchange,
                                         std::span<const glm::vec3> sent) {
    std::vector<glm::vec3> gathered(sent.size());
    const float share = 1.0f / static_cast<float>(exchange.rays());
    parallel_for(gathered.size(), 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            glm::vec3 sum(0.0f);
            for (std::size_t k = exchange.first[i]; k < exchange.first[i + 1]; ++k) {
                sum += sent[exchange.seen[k] / kMostNodeRays];
            }
            gathered[i] = share * sum;
        }
    });
    return gathered;
}

ExchangedLight exchanged_at_nodes(const NodeExchange& exchange,
                                  const DirectLight& direct,
                                  const NodeReflectance& reflectance,
                                  int bounces) {
    const std::size_t count = direct.on_diffuser.size();
    const float share = 1.0f / static_cast<float>(exchange.rays());
    ExchangedLight made;
    made.on_diffuser.assign(count, glm::vec3(0.0f));
    made.sent = {direct.along.first, std::vector<glm::vec3>(direct.along.values.size())};
    NodeLight before = made.sent;
    std::vector<glm::vec3> last(count);  // bounce's light on a diffuser
    // Lobes pass on most of what they see: where it goes is followed twice, then how much
    constexpr int kFewestBetweenLobes = 2, kMostEvenly = 16;
    const int most =
        reflectance.matrices.empty() ? bounces : std::max(bounces, kFewestBetweenLobes);
    // Bounce 0 is of what comes from outside
    float first = 0.0f;
    for (int bounce = 0; bounce <= most; ++bounce) {
        std::swap(before, made.sent);
        parallel_for(count, 1024, [&](std::size_t begin, std::size_t end) {
            std::array<glm::vec3, kMostNodeRays> comes;
            for (std::size_t i = begin; i < end; ++i) {
                const std::span<const glm::vec3> own = direct.along.of(i);
                const bool by_ray = own.size() > 1;
                if (by_ray) std::copy(own.begin(), own.end(), comes.begin());
                glm::vec3 sum(0.0f);
                for (std::size_t k = exchange.first[i]; bounce > 0 && k < exchange.first[i + 1];
                     ++k) {
                    const glm::vec3& seen = before.along(exchange.seen[k]);
                    sum += seen;
                    if (by_ray) comes[exchange.by[k]] += seen;
                }
                if (bounce > 0) {
                    last[i] = share * sum - made.on_diffuser[i];
                    made.on_diffuser[i] = share * sum;
                }
                reflectance.send(exchange.nodes,
                                 i,
                                 direct.on_diffuser[i] + made.on_diffuser[i],
                                 std::span(comes).first(own.size()),
                                 made.sent.of(i));
            }
        });
        if (bounce == 0) continue;
        const float largest = brightest_of(last);
        if (bounce == 1) first = largest;
        if (largest <= kNothingLeft * first) return made;
    }
    if (most == bounces) return made;
    std::vector<glm::vec3> left(count, glm::vec3(0.0f));
    for (int bounce = 0; bounce < kMostEvenly; ++bounce) {
        for (std::size_t i = 0; i < count; ++i) last[i] *= reflectance.albedo[i];
        last = gathered_at_nodes(exchange, last);
        for (std::size_t i = 0; i < count; ++i) left[i] += last[i];
        if (brightest_of(last) <= kNothingLeft * first) break;
    }
    for (std::size_t i = 0; i < count; ++i) {
        made.on_diffuser[i] += left[i];
        for (glm::vec3& sent : made.sent.of(i)) sent += reflectance.albedo[i] * left[i];
    }
    return made;
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
