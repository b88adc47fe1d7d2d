// How a product darkens the ground that it stands on: by the sky that it hides.
#pragma once

#include "core/image.h"
#include "scene/product.h"
#include "tracing/tracer.h"

namespace livery {

/// On the plane under the lowest point of the product; independent of lights and views.
struct GroundShadow {
    double height_mm = 0.0;
    glm::dvec2 corner_mm{0.0};  ///< x and z of the picture's first corner
    glm::dvec2 size_mm{1.0};
    Image8 hidden;  ///< one channel, 255: no sky at all; columns along x, rows along z
};
GroundShadow ground_shadow(const Product& product, const Tracer& tracer);

}  // namespace livery
