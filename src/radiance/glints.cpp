#include "radiance/glints.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "core/mutation.h"

namespace livery {

PixelSize pixel_size_of(const View& view) {
    const glm::dmat3 world_from_view = glm::transpose(view.view_from_world.rotation);
    return {centre_in_world(view),
            world_from_view[2],
            1.0 / std::sqrt(view.focal_px.x * view.focal_px.y)};
}

double pixel_side_mm(const PixelSize& pixels,
                     const glm::dvec3& position_mm,
                     const glm::dvec3& normal) {
    // A pixel's solid angle is its area at one mm times the third power of its cosine to the axis;
    // what it covers is that times distance^2 over the surface's cosine.
    const glm::dvec3 apart = position_mm - pixels.from_mm;
    const double depth = std::max(glm::dot(apart, pixels.axis), 0.0);
    const double facing = std::max(std::abs(glm::dot(apart, normal)), 0.1 * glm::length(apart));
    if (!(facing > 0.0)) return 0.0;
    return LIVERY_MUTATED(glint_pixel,
                          pixels.at_one_mm * std::sqrt(depth * depth * depth / facing));
}

double glint_density_on_mock_up(const Material& material, double product_scale) {
    const double larger = product_scale / material.glint_scale;
    return LIVERY_MUTATED(glint_density, material.glint_density_per_mm2 * larger * larger);
}

}  // namespace livery
