#include "reference/paths.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include "appearance/bsdf_source.h"
#include "appearance/paint_figures.h"
#include "appearance/subsurface/translucent_paint.h"
#include "core/colour.h"
#include "core/error.h"
#include "core/mutation.h"
#include "reference/subsurface_walk.h"
#include "scene/artwork_cover.h"
#include "tracing/closed_part.h"

namespace livery {

namespace {

ArrivingLight arriving(const DiscLight& light, Random& random) {
    if (light.is_point()) return {glm::dvec3(light.direction()), glm::dvec3(light.irradiance())};
    const glm::vec2 u(random.uniform_float(), random.uniform_float());
    const LightSample sample = light.sample(u);
    return {glm::dvec3(sample.direction), glm::dvec3(sample.radiance / sample.pdf)};
}

/// On the surface over a point of the plane that an open part is taken for.
BoundaryPoint onto_surface(BoundaryPoint at,
                           const TranslucentPart& part,
                           const Mesh& mesh,
                           const Tracer& tracer,
                           const SurfaceEntry& entry) {
    const bool other_side = glm::dot(at.geometric_normal, entry.geometric_normal) < 0.0;
    const double behind_mm = other_side ? part.sheet_mm.value_or(0.0) : 0.0;
    const glm::dvec3 over = at.position + behind_mm * entry.geometric_normal;
    const double height = glm::distance(over, entry.position);
    TraceRay ray;
    ray.origin = glm::vec3(over + height * entry.geometric_normal);
    ray.direction = -glm::vec3(entry.geometric_normal);
    ray.t_max = static_cast<float>(2.0 * height);
    const Hit hit = height > 0.0 ? tracer.closest(ray) : Hit{};
    glm::dvec3 position = entry.position, normal = entry.geometric_normal;
    if (hit.valid()) {
        const SurfacePoint point = surface_point(mesh, hit);
        // Whichever side the walk began on
        const glm::vec3 faces = glm::dot(point.geometric_normal, ray.direction) < 0.0f
                                    ? point.geometric_normal
                                    : -point.geometric_normal;
        if (point.part == part.part) {
            position = glm::dvec3(point.position_mm);
            normal = glm::dvec3(faces);
        }
    }
    at.position = position - behind_mm * normal;
    at.geometric_normal = other_side ? -normal : normal;
    return at;
}

}  // namespace

std::optional<TranslucentPart> translucent_part(const Product& product,
                                                const Material& material,
                                                std::size_t part) {
    if (!is_translucent(material)) return std::nullopt;
    const TranslucentMaterial medium = on_mock_up(*material.medium, product.product_scale);
    return TranslucentPart{walk_medium(medium),
                           static_cast<std::uint16_t>(part),
                           is_closed(product.mesh, part),
                           medium.thickness_mm};
}

Material boundary_alone(const Material& translucent) {
    Material mirror = albedo_paint(translucent);
    mirror.diffuse = glm::dvec3(0.0);
    return mirror;
}

float chance_of_mirroring(const TranslucentPart& part, float cosine) {
    const double mirrored = dielectric_reflectance(
        static_cast<double>(std::clamp(cosine, 0.0f, 1.0f)), part.medium.eta);
    if (!(mirrored > 0.0)) return 0.0f;
    // Of walks one learns more
    return static_cast<float>(std::clamp(mirrored, 0.1, 0.9));
}

WalkedLight walk_through(const TranslucentPart& part,
                         const Mesh& mesh,
                         const Tracer& tracer,
                         const WalkLamps& lights,
                         const SurfaceEntry& entry,
                         double channel,
                         Random& random) {
    WalkedLight light;
    const double eta = part.medium.eta;
    const double cosine = std::clamp(glm::dot(entry.toward_eye, entry.normal), 0.0, 1.0);
    const auto inward = refracted(-entry.toward_eye, entry.normal, eta);
    if (!inward) return light;
    const double entering = 1.0 - dielectric_reflectance(cosine, eta);
    // The radiance of a beam that leaves is that inside over the index squared (Veach 1997)
    const double narrowed = entering / (eta * eta);

    const PartBoundary closed(mesh, tracer, part.part);
    const PlaneBoundary open(entry.position, entry.geometric_normal, part.sheet_mm);
    const Boundary& boundary = part.closed ? static_cast<const Boundary&>(closed) : open;
    const auto on_surface = [&](const BoundaryPoint& at) {
        return part.closed ? at : onto_surface(at, part, mesh, tracer, entry);
    };
    WalkLights lamps;
    lamps.each = [&](const glm::dvec3& point,
                     Random& numbers,
                     const std::function<void(const ArrivingLight&)>& use) {
        for (const DiscLight& one : lights.discs) {
            if (one.irradiance() != glm::vec3(0.0f)) use(arriving(one, numbers));
        }
        if (!lights.projected) return;
        ArrivingLight picture;
        picture.direction = glm::dvec3(lights.projected->at(point).direction);
        picture.projected = true;
        use(picture);
    };
    lamps.reaching = [&](const BoundaryPoint& at, const ArrivingLight& arriving) {
        const BoundaryPoint place = on_surface(at);
        glm::dvec3 irradiance = arriving.irradiance;
        TraceRay ray;
        if (arriving.projected) {
            const auto there = lights.projected->at(place.position);
            irradiance = glm::dvec3(there.irradiance);
            ray.t_max = there.distance_mm;
        }
        if (irradiance == glm::dvec3(0.0)) return irradiance;
        const glm::dvec3 nothing(0.0);
        if (!(glm::dot(place.geometric_normal, arriving.direction) > 0.0)) return nothing;
        ray.origin = offset_origin(glm::vec3(place.position), glm::vec3(place.geometric_normal));
        ray.direction = glm::vec3(arriving.direction);
        return tracer.occluded(ray) ? nothing : irradiance;
    };
    const glm::dmat3& working = working_from_rec709();
    BoundaryPoint start;
    start.position = entry.position;
    start.geometric_normal = entry.geometric_normal;
    glm::dvec3 direction = *inward;
    // A shading normal may send it out of the surface
    if (!(glm::dot(direction, entry.geometric_normal) < 0.0)) {
        direction -= 2.0 * glm::dot(direction, entry.geometric_normal) * entry.geometric_normal;
    }
    const WalkResult walked = walk_inside(
        part.medium,
        boundary,
        boundary.inside_of(start),
        direction,
        channel,
        lights.discs.empty() && !lights.projected ? nullptr : &lamps,
        [&](const glm::dvec3& weight, const glm::dvec3& irradiance) {
            light.of_lamps += narrowed * (working * weight) * irradiance;
        },
        random);
    if (!walked.left) return light;
    const BoundaryPoint out = on_surface(walked.at);
    light.left = true;
    light.origin = offset_origin(glm::vec3(out.position), glm::vec3(out.geometric_normal));
    light.direction = glm::vec3(walked.direction);
    light.weight = entering * (working * walked.weight);
    return light;
}

namespace {

/// The balance heuristic's weight of the first of two ways to find the same light.
float balance(float used, float other) {
    return LIVERY_MUTATED(reference_balance, used / (used + other));
}

/// The largest float below 1.
constexpr float kBelowOne = 0x1.fffffep-1f;

/// From this scattering on paths of little weight are ended by chance (Russian roulette).
constexpr int kFirstRoulette = 4;

}  // namespace

/// A point of a path: its shading frame and its paint.
struct PathScene::Vertex {
    glm::vec3 position;
    glm::vec3 geometric_normal;
    glm::mat3 world_from_local;
    glm::vec3 wo;  ///< local
    const PaintBsdf& bsdf;
    float chance = 1.0f;  ///< that a direction is sampled of what is reflected

    Vertex(const PaintBsdf& its_bsdf, const SurfacePoint& point, const glm::vec3& toward_eye)
        : position(point.position_mm), geometric_normal(point.geometric_normal), bsdf(its_bsdf) {
        const glm::vec3 n = point.normal;
        glm::vec3 t = glm::vec3(point.tangent) - glm::dot(glm::vec3(point.tangent), n) * n;
        if (glm::dot(t, t) < 1e-12f) {
            t = glm::cross(std::abs(n.y) < 0.9f ? glm::vec3(0, 1, 0) : glm::vec3(1, 0, 0), n);
        }
        t = glm::normalize(t);
        world_from_local = glm::mat3(t, point.tangent.w * glm::cross(n, t), n);

        wo = glm::transpose(world_from_local) * f32::seen_from(toward_eye, n);
        wo.z = std::max(wo.z, 0.5e-4f);
    }

    glm::vec3 to_local(const glm::vec3& v) const { return glm::transpose(world_from_local) * v; }
    bool above(const glm::vec3& direction) const {
        return glm::dot(direction, geometric_normal) > 0.0f;
    }
};

PathScene::PathScene(const Scene& scene, const ReferenceOptions& options)
    : mesh_(scene.product->mesh),
      options_(options),
      tracer_(scene.product->mesh),
      artwork_(scene.artwork),
      environment_(scene.environment.get()) {
    check_argument(scene.part_materials.size() == mesh_.parts.size(),
                   fmt::format("the scene has {} materials for {} parts",
                               scene.part_materials.size(),
                               mesh_.parts.size()));
    for (std::size_t p = 0; p < mesh_.parts.size(); ++p) {
        const Material& material = scene.part_materials[p];
        translucent_.push_back(translucent_part(*scene.product, material, p));
        bsdfs_.push_back(bsdf_of(translucent_[p] ? boundary_alone(material) : material));
    }
    for (std::size_t p = 0; p < mesh_.parts.size(); ++p) {
        const PartArtwork* relief = relief_of(scene, p);
        reliefs_.push_back(relief ? std::optional(*relief) : std::nullopt);
    }
    for (const PartArtwork& artwork : artwork_) artwork_bsdfs_.push_back(bsdf_of(artwork.material));
    for (const DirectionalLight& light : scene.lights) lights_.emplace_back(light);
}

SurfacePoint PathScene::surface_at(const Hit& hit, const glm::vec3& ray_direction) const {
    SurfacePoint point = surface_point(mesh_, hit);
    if (glm::dot(point.geometric_normal, ray_direction) > 0.0f) {
        point.geometric_normal = -point.geometric_normal;
        point.normal = -point.normal;
    }
    const std::optional<PartArtwork>& relief = reliefs_[point.part];
    if (!relief) return point;
    const glm::dvec3 normal(point.normal);
    const ArtworkPoint at =
        artwork_at(*relief, glm::dvec3(point.position_mm), normal, glm::dvec2(point.uv));
    const ReliefFrame frame = relief_frame(*relief, normal, glm::dvec4(point.tangent));
    point.normal = glm::vec3(tilted(normal, frame, tilt_at(*relief, at).slope));
    return point;
}

const PaintBsdf& PathScene::bsdf_at(const SurfacePoint& point,
                                    float chance,
                                    PaintBsdf& made) const {
    for (std::size_t k = artwork_.size(); k-- > 0;) {
        const PartArtwork& artwork = artwork_[k];
        if (artwork.part != point.part) continue;
        const ArtworkPoint at = artwork_at(
            artwork, glm::dvec3(point.position_mm), glm::dvec3(point.normal), glm::dvec2(point.uv));
        const float cover = static_cast<float>(at.cover);
        if (!(chance < cover)) {
            // Of the paints below, the number is again any of [0, 1).
            chance = std::min((chance - cover) / (1.0f - cover), kBelowOne);
            continue;
        }
        const bool same_everywhere = artwork.artwork.use == PictureUse::cover;
        if (same_everywhere) return artwork_bsdfs_[k];
        made = bsdf_of(material_at(artwork, at.rgba));
        return made;
    }
    return bsdfs_[point.part];
}

bool PathScene::open(const Vertex& vertex, const glm::vec3& direction, float distance_mm) const {
    TraceRay ray;
    ray.origin = offset_origin(vertex.position, vertex.geometric_normal);
    ray.direction = direction;
    ray.t_max = distance_mm;
    return !tracer_.occluded(ray);
}

glm::vec3 PathScene::light_on(const Vertex& vertex,
                              const PathNumbers& numbers,
                              const SobolPoint& at,
                              std::uint32_t bounce) const {
    glm::vec3 sum(0.0f);
    // Reflected light before its distance: value x cosine, 0 where nothing can come from there
    const auto reflected = [&](const glm::vec3& direction, glm::vec3& wi) {
        wi = vertex.to_local(direction);
        if (wi.z <= 0.0f || !vertex.above(direction)) return glm::vec3(0.0f);
        return evaluate(vertex.bsdf, wi, vertex.wo) * wi.z;
    };
    const auto add = [&](const LightSample& light) {
        if (light.pdf <= 0.0f) return;
        glm::vec3 wi;
        const glm::vec3 value = reflected(light.direction, wi);
        if (value == glm::vec3(0.0f) || !open(vertex, light.direction)) return;
        float weight = 1.0f;
        if (options_.sampling == ReferenceSampling::combined) {
            weight = balance(light.pdf, vertex.chance * pdf(vertex.bsdf, wi, vertex.wo));
        }
        sum += value * light.radiance * (weight / light.pdf);
    };
    for (std::size_t l = 0; l < lights_.size(); ++l) {
        const DiscLight& light = lights_[l];
        if (light.is_point()) {
            glm::vec3 wi;
            const glm::vec3 value = reflected(light.direction(), wi);
            if (value != glm::vec3(0.0f) && open(vertex, light.direction())) {
                sum += value * light.irradiance();
            }
        } else if (options_.sampling != ReferenceSampling::reflectance) {
            add(light.sample(numbers.on_light(at, bounce, static_cast<std::uint32_t>(l))));
        }
    }
    if (options_.projected) {
        const auto arriving = options_.projected->at(glm::dvec3(vertex.position));
        glm::vec3 wi;
        const glm::vec3 value = arriving.irradiance == glm::vec3(0.0f)
                                    ? glm::vec3(0.0f)
                                    : reflected(arriving.direction, wi);
        if (value != glm::vec3(0.0f) && open(vertex, arriving.direction, arriving.distance_mm)) {
            sum += value * arriving.irradiance;
        }
    }
    if (!environment_.empty() && options_.sampling != ReferenceSampling::reflectance) {
        add(environment_.sample(at.pair(PathNumbers::environment)));
    }
    return sum;
}

glm::vec3 PathScene::light_along(const glm::vec3& direction, float reflectance_pdf) const {
    if (options_.sampling == ReferenceSampling::lights) return glm::vec3(0.0f);
    glm::vec3 sum(0.0f);
    const auto add = [&](const LightSample& light) {
        const bool alone = options_.sampling == ReferenceSampling::reflectance;
        sum += light.radiance * (alone ? 1.0f : balance(reflectance_pdf, light.pdf));
    };
    for (const DiscLight& light : lights_) add(light.along(direction));
    if (!environment_.empty()) add(environment_.along(direction));
    return sum;
}

bool PathScene::pass_through(const TranslucentPart& part,
                             const Vertex& vertex,
                             float channel,
                             Random random,
                             glm::vec3& throughput,
                             glm::vec3& sum,
                             TraceRay& out) const {
    SurfaceEntry entry;
    entry.position = glm::dvec3(vertex.position);
    entry.geometric_normal = glm::dvec3(vertex.geometric_normal);
    entry.normal = glm::dvec3(vertex.world_from_local[2]);
    entry.toward_eye = glm::dvec3(vertex.world_from_local * vertex.wo);
    const WalkedLight walked = walk_through(part,
                                            mesh_,
                                            tracer_,
                                            {lights_, options_.projected.get()},
                                            entry,
                                            static_cast<double>(channel),
                                            random);
    sum += throughput * glm::vec3(walked.of_lamps);
    if (!walked.left) return false;
    throughput *= glm::vec3(walked.weight);
    out.origin = walked.origin;
    out.direction = walked.direction;
    return true;
}

glm::vec3 PathScene::surroundings_along(const glm::vec3& direction) const {
    // Lamps were asked for at every scattering
    return environment_.empty() ? glm::vec3(0.0f) : environment_.along(direction).radiance;
}

glm::vec3 PathScene::radiance(SurfacePoint point, glm::vec3 wo, const PathNumbers& numbers) const {
    glm::vec3 sum(0.0f), throughput(1.0f);
    for (int bounce = 0;; ++bounce) {
        const auto b = static_cast<std::uint32_t>(bounce);
        const SobolPoint at = numbers.at(b);
        PaintBsdf made;
        Vertex vertex(bsdf_at(point, at[PathNumbers::paint], made), point, wo);
        const TranslucentPart* inside =
            &vertex.bsdf == &bsdfs_[point.part] && translucent_[point.part]
                ? &*translucent_[point.part]
                : nullptr;
        if (inside) vertex.chance = chance_of_mirroring(*inside, vertex.wo.z);
        sum += throughput * light_on(vertex, numbers, at, b);

        glm::vec3 u(at.pair(PathNumbers::direction), at[PathNumbers::lobe]);
        TraceRay ray;
        float density = 0.0f;
        const bool enters = inside && !(u.z < vertex.chance);
        if (enters) {
            throughput *= 1.0f / (1.0f - vertex.chance);
            const float channel = (u.z - vertex.chance) / (1.0f - vertex.chance);
            if (!pass_through(
                    *inside, vertex, channel, numbers.independent(b), throughput, sum, ray)) {
                return sum;
            }
        } else {
            u.z = std::min(u.z / vertex.chance, kBelowOne);
            const glm::vec3 wi = sample(vertex.bsdf, vertex.wo, u);
            if (!(wi.z > 0.0f)) return sum;
            ray.direction = glm::normalize(vertex.world_from_local * wi);
            density = vertex.chance * pdf(vertex.bsdf, wi, vertex.wo);
            if (!(density > 0.0f) || !vertex.above(ray.direction)) return sum;
            throughput *= LIVERY_MUTATED(reference_throughput,
                                         evaluate(vertex.bsdf, wi, vertex.wo) * (wi.z / density));
            ray.origin = offset_origin(vertex.position, vertex.geometric_normal);
        }
        const glm::vec3 direction = ray.direction;
        const Hit hit = tracer_.closest(ray);
        if (!hit.valid()) {
            return sum + throughput * (enters ? surroundings_along(direction)
                                              : light_along(direction, density));
        }
        if (bounce == options_.bounces) return sum;
        if (bounce + 1 >= kFirstRoulette) {
            const float survival =
                std::min(1.0f, std::max({throughput.x, throughput.y, throughput.z}));
            if (!(at[PathNumbers::roulette] < survival)) return sum;
            throughput /= survival;
        }
        // The inside of a closed surface is dark.
        if (!has_two_sides(mesh_, hit.triangle) && sees_back(mesh_, hit, direction)) return sum;
        point = surface_at(hit, direction);
        wo = -direction;
    }
}

}  // namespace livery
