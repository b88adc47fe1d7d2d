// Photographs of projected pictures, traced: a grey mock-up and what stands around it, lit by the
// projector alone, with its shadows, sampled over each camera pixel, with noise.
#pragma once

#include <cmath>
#include <vector>

#include <glm/geometric.hpp>

#include "core/bench_ports.h"
#include "core/parallel.h"
#include "core/random.h"
#include "mesh/mesh.h"
#include "scene/view.h"
#include "tracing/tracer.h"

namespace livery::testing {

/// Light of 1 at a millimetre^2's worth of full drive from the middle of the mesh; `ambient` and
/// `noise` (a photograph's, Gaussian) over that. 3 x 3 rays a pixel.
inline std::vector<Photograph> traced_photographs(const Mesh& world,
                                                  const View& projector,
                                                  const View& camera,
                                                  const std::vector<Image8>& pictures,
                                                  double noise,
                                                  std::uint64_t seed,
                                                  double ambient = 0.02) {
    constexpr int kSide = 3;
    const Tracer tracer(world);
    const glm::dvec3 lamp = centre_in_world(projector), eye = centre_in_world(camera);
    const double nominal2 = glm::dot(lamp, lamp);
    std::vector<Photograph> photographs(pictures.size());
    for (Photograph& photograph : photographs)
        photograph.image = ImageF(camera.width, camera.height, 1);
    parallel_for(static_cast<std::size_t>(camera.height), 8, [&](std::size_t from, std::size_t to) {
        std::vector<glm::vec3> directions(static_cast<std::size_t>(camera.width * kSide));
        std::vector<Hit> hits(directions.size());
        for (int y = static_cast<int>(from); y < static_cast<int>(to); ++y)
            for (int row = 0; row < kSide; ++row) {
                for (std::size_t i = 0; i < directions.size(); ++i)
                    directions[i] = glm::vec3(ray_through(camera,
                                                          {(static_cast<double>(i) + 0.5) / kSide,
                                                           y + (row + 0.5) / kSide})
                                                  .direction);
                tracer.closest_from(glm::vec3(eye), directions, hits);
                for (std::size_t i = 0; i < hits.size(); ++i) {
                    const int x = static_cast<int>(i) / kSide;
                    double cosine = 0.0;
                    int column = -1, line = -1;
                    if (hits[i].valid()) {
                        const SurfacePoint point = surface_point(world, hits[i]);
                        const glm::dvec3 place(point.position_mm), to_lamp = lamp - place;
                        TraceRay shadow;
                        shadow.origin = offset_origin(point.position_mm, point.geometric_normal);
                        shadow.direction = glm::vec3(to_lamp);
                        shadow.t_max = 1.0f;
                        const auto lit = project(projector, place);
                        const double facing =
                            glm::dot(glm::dvec3(point.normal), to_lamp) / glm::length(to_lamp);
                        if (lit && facing > 0.0 && lit->x >= 0.0 && lit->y >= 0.0 &&
                            lit->x < projector.width && lit->y < projector.height &&
                            !tracer.occluded(shadow)) {
                            cosine = facing * nominal2 / glm::dot(to_lamp, to_lamp);
                            column = static_cast<int>(lit->x);
                            line = static_cast<int>(lit->y);
                        }
                    }
                    for (std::size_t k = 0; k < pictures.size(); ++k) {
                        const bool on = column >= 0 && pictures[k].at(column, line) > 127;
                        photographs[k].image.at(x, y) +=
                            static_cast<float>((ambient + (on ? cosine : 0.0)) / (kSide * kSide));
                    }
                }
            }
    });
    Random random(seed, 5);
    for (Photograph& photograph : photographs)
        for (float& value : photograph.image.values)
            value += static_cast<float>(noise * random.normal());
    return photographs;
}

}  // namespace livery::testing
