// What single flakes depend on besides light and eye (shaders/radiance/glints.glsl): how much of
// the surface a pixel covers, and how many flakes there are on it.
#pragma once

#include <glm/vec3.hpp>

#include "appearance/material.h"
#include "scene/view.h"

namespace livery {

/// Pixels of a view where its lens is ideal: the one that a fragment lies in is no larger for a few
/// percent of distortion.
struct PixelSize {
    glm::dvec3 from_mm{0.0};         ///< centre of the view
    glm::dvec3 axis{0.0, 0.0, 1.0};  ///< where it looks
    double at_one_mm = 0.0;          ///< side of a pixel on the plane one mm away
};
PixelSize pixel_size_of(const View& view);

/// Side of the square that a pixel covers on a surface there, in mm. A surface seen at less than
/// 6 degrees counts as seen at that.
double pixel_side_mm(const PixelSize& pixels,
                     const glm::dvec3& position_mm,
                     const glm::dvec3& normal);

/// Flakes on a square millimetre of a mock-up of that scale (Product::product_scale), as large as
/// they are drawn.
double glint_density_on_mock_up(const Material& material, double product_scale);

}  // namespace livery
