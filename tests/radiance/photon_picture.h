// What a view sees of light that entered a translucent part and left it again, by photons from a
// lamp: every walk is scored, so that it knows a shadow's inside a hundred times better than walks
// from the eye do in the same time.
#pragma once

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include <glm/geometric.hpp>

#include "appearance/paint_figures.h"
#include "appearance/subsurface/scattering_medium.h"
#include "appearance/subsurface/translucent_paint.h"
#include "core/colour.h"
#include "core/image.h"
#include "core/parallel.h"
#include "core/random.h"
#include "reference/subsurface_walk.h"
#include "scene/scene.h"
#include "scene/view.h"
#include "tracing/tracer.h"

namespace livery {

/// Radiance in the working space from the first lamp of the scene, through its first part, which is
/// closed; `around_mm` is a ball that holds it. What leaves does so as a cosine does under the
/// boundary (within .4% at high albedo).
inline ImageF photon_picture(const Scene& scene,
                             const View& view,
                             double around_mm,
                             std::size_t photons,
                             std::uint64_t seed = 1) {
    const Material& paint = scene.part_materials[0];
    const WalkMedium medium = walk_medium(on_mock_up(*paint.medium, scene.product->product_scale));
    const Mesh& mesh = scene.product->mesh;
    const Tracer tracer(mesh);
    const PartBoundary boundary(mesh, tracer, 0);
    const DirectionalLight& lamp = scene.lights[0];
    const glm::dvec3 toward = glm::normalize(lamp.direction);
    const glm::dvec3 u = glm::normalize(glm::cross(toward, glm::dvec3(1.0, 0.0, 0.0)));
    const glm::dvec3 v = glm::cross(toward, u);
    const glm::dvec3 radiance = working_from_rec709() * lamp.radiance_rec709;
    const double power = std::numbers::pi * around_mm * around_mm / static_cast<double>(photons);
    // (1 - F) cos over the hemisphere, where a white diffuser has cos
    const double leaves = 2.0 * medium.eta * medium.eta * fresnel_moments(medium.eta).passed[0];
    const glm::dvec3 eye = scene.eye_in_world_mm, lens = centre_in_world(view);
    const Ray axis = ray_through(view, view.principal_px);

    constexpr std::size_t kBatches = 64;
    const auto pixels = static_cast<std::size_t>(view.width * view.height);
    std::vector<std::vector<glm::dvec3>> sums(kBatches, std::vector<glm::dvec3>(pixels));
    const auto photon = [&](Random& random, std::vector<glm::dvec3>& sum) {
        const auto in_disc = [&](double radius) {
            const double r = radius * std::sqrt(random.uniform());
            const double angle = 2.0 * std::numbers::pi * random.uniform();
            return r * std::cos(angle) * u + r * std::sin(angle) * v;
        };
        const glm::dvec3 way = -glm::normalize(toward + in_disc(std::tan(0.5 * lamp.angle_rad)));
        TraceRay ray;
        ray.origin = glm::vec3(in_disc(around_mm) - 10.0 * around_mm * way);
        ray.direction = glm::vec3(way);
        const Hit hit = tracer.closest(ray);
        if (!hit.valid()) return;
        const SurfacePoint in = surface_point(mesh, hit);
        if (in.part != 0) return;
        const glm::dvec3 normal(in.normal);
        const double cosine = -glm::dot(way, normal);
        if (!(cosine > 0.0)) return;
        const auto inward = refracted(way, normal, medium.eta);
        if (!inward) return;
        const double enters = 1.0 - dielectric_reflectance(cosine, medium.eta);
        BoundaryPoint start;
        start.position = glm::dvec3(in.position_mm);
        start.geometric_normal = glm::dvec3(in.geometric_normal);
        const WalkResult walked = walk_inside(medium,
                                              boundary,
                                              boundary.inside_of(start),
                                              *inward,
                                              random.uniform(),
                                              nullptr,
                                              {},
                                              random);
        // The eye does not look into what goes straight through
        if (!walked.left || glm::dot(walked.direction, way) > 0.9999) return;
        // Seen from the view, shaded for the eye
        const glm::dvec3& out = walked.at.position;
        const glm::dvec3 to_lens = glm::normalize(lens - out);
        const double seen = glm::dot(to_lens, walked.at.geometric_normal);
        const double exits = glm::dot(glm::normalize(eye - out), walked.at.normal);
        const auto at = project(view, out);
        if (!(seen > 0.0) || !(exits > 0.0) || !at) return;
        const int x = static_cast<int>(std::floor(at->x)), y = static_cast<int>(std::floor(at->y));
        if (x < 0 || y < 0 || x >= view.width || y >= view.height) return;
        const double lobe = (1.0 - dielectric_reflectance(exits, medium.eta)) / leaves;
        const double slant = -glm::dot(to_lens, axis.direction);
        const double solid_angle = slant * slant * slant / (view.focal_px.x * view.focal_px.y);
        const glm::dvec3 off = lens - out;
        sum[static_cast<std::size_t>(y * view.width + x)] +=
            (power * enters * lobe * seen / (glm::dot(off, off) * solid_angle)) *
            (working_from_rec709() * walked.weight) * radiance;
    };
    parallel_for(kBatches, 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) {
            Random random(seed, k);
            for (std::size_t n = 0; n < photons / kBatches; ++n) photon(random, sums[k]);
        }
    });
    ImageF picture(view.width, view.height, 4);
    for (std::size_t p = 0; p < pixels; ++p) {
        glm::dvec3 all(0.0);
        for (const auto& sum : sums) all += sum[p];
        float* pixel = picture.values.data() + 4 * p;
        for (int c = 0; c < 3; ++c) pixel[c] = static_cast<float>(all[c]);
        pixel[3] = 1.0f;
    }
    return picture;
}

}  // namespace livery
