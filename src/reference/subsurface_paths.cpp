#include "reference/subsurface_paths.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "appearance/paint_figures.h"
#include "appearance/subsurface/translucent_paint.h"
#include "core/colour.h"
#include "reference/part_boundary.h"
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

}  // namespace livery
