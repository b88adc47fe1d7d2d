// A shipped bench as geometry alone: its mock-up, what stands around it, projector and camera.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "calibration/support/traced_sights.h"
#include "core/statistics.h"
#include "scene/product.h"
#include "twin/description.h"

namespace livery::testing {

struct BenchWorld {
    Mesh product;
    Mesh all;
    View projector, camera;  ///< world: the product's frame
};

inline BenchWorld bench_world(const std::string& bench_name,
                              std::optional<Mesh> product = std::nullopt) {
    const BenchDescription bench = read_bench_file(bench_name);
    BenchWorld world{product ? *product : load_product(bench.product).mesh,
                     {},
                     bench.projector.view,
                     bench.camera.view};
    world.all = world.product;
    for (const auto& [name, one] : bench.surroundings)
        add_rectangle(world.all,
                      glm::vec3(one.corner_mm),
                      glm::vec3(one.side_a_mm),
                      glm::vec3(one.side_b_mm));
    return world;
}

/// With a quarter of the pixels.
inline BenchWorld half_size_world(const std::string& bench_name,
                                  std::optional<Mesh> product = std::nullopt) {
    BenchWorld world = bench_world(bench_name, std::move(product));
    for (View* view : {&world.projector, &world.camera})
        *view = resized(*view, view->width / 2, view->height / 2);
    return world;
}

/// What the geometry's calibration says: the camera's frame is the world, focal lengths are off by
/// a share, the projector's the other way.
struct Given {
    View projector;
    std::vector<Sight> sights;
};
inline Given given_of(const BenchWorld& world, double lens_off, std::uint64_t seed) {
    Given given;
    given.sights = {traced_sight(world.all, world.projector, world.camera, 0.1, seed)};
    const Rigid3 world_from_camera = inverse(world.camera.view_from_world);
    given.projector = world.projector;
    given.projector.view_from_world = world.projector.view_from_world * world_from_camera;
    given.sights[0].camera.view_from_world = Rigid3{};
    given.projector.focal_px *= 1.0 - lens_off;
    given.sights[0].camera.focal_px *= 1.0 + lens_off;
    return given;
}

struct DrawnErrors {
    double median_px = 0.0, p95_px = 0.0;
};

/// Over the lit mesh: how far from its true place each point is drawn in the projector's picture.
inline DrawnErrors drawn_errors(const BenchWorld& world, const View& believed) {
    const Tracer tracer(world.product);
    std::vector<double> errors;
    for (int y = 0; y < world.projector.height; y += 8)
        for (int x = 0; x < world.projector.width; x += 8) {
            const Ray ray = ray_through(world.projector, {x + 0.5, y + 0.5});
            TraceRay trace;
            trace.origin = glm::vec3(ray.origin);
            trace.direction = glm::vec3(ray.direction);
            const Hit hit = tracer.closest(trace);
            if (!hit.valid()) continue;
            const auto drawn = project(believed, surface_point(world.product, hit).position_mm);
            errors.push_back(drawn ? glm::length(*drawn - glm::dvec2(x + 0.5, y + 0.5)) : 1e3);
        }
    return {quantile(errors, 0.5), quantile(errors, 0.95)};
}

}  // namespace livery::testing
