// Where a camera's pixels lie in a plane.
#pragma once

#include <glm/vec3.hpp>

#include "core/image.h"
#include "scene/view.h"

namespace livery {

struct SamplePlane {
    glm::dvec3 point_mm{0.0};
    glm::dvec3 normal{0.0, 0.0, 1.0};  ///< unit length, toward the camera
};

/// 4 channels: place in the plane (mm, two axes at right angles from its point), area of the plane
/// that the pixel sees (mm^2), cosine of the line of sight to the normal. Area 0: it does not see
/// the plane.
using PlanePixels = ImageF;
PlanePixels plane_pixels(const View& view, const SamplePlane& plane);

/// Axes of the plane's places: `across` and cross(normal, across).
glm::dvec3 axis_across(const SamplePlane& plane);

}  // namespace livery
