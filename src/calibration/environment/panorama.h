// A panorama of the light all around, and how it was turned when it was taken.
#pragma once

#include <span>

#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "calibration/environment/light_picture.h"

namespace livery {

/// From the frame of a camera whose panorama's middle looks `yaw` to the left of the world's -z
/// (counter-clockwise seen from above) and `pitch` up, and which leaned `roll` to its right.
glm::dmat3 world_from_panorama(double yaw_rad, double pitch_rad, double roll_rad);

/// Something that is seen in the panorama, and which way it lies.
struct PanoramaMark {
    glm::dvec2 pixel{0.0};      ///< centres at half integers
    glm::dvec3 direction{0.0};  ///< in the world, of any length
};

struct PanoramaOrientation {
    glm::dmat3 world_from_panorama{1.0};
    double residual_rad = 0.0;  ///< by how much the marks' angle differs from the directions'
};

/// The turn that takes both marks as near to their directions as each other (TRIAD, Black 1964,
/// about their bisector). Throws Refused for marks less than 10 degrees apart or opposite, or for
/// directions that lie more than 10 degrees further from one another than the marks.
PanoramaOrientation orientation_of(const PanoramaMark& first,
                                   const PanoramaMark& second,
                                   int width,
                                   int height);

/// Where a panorama of that size (latitude-longitude, as scene/look.h has it) shows directions.
SeeDirection seen_in_panorama(const glm::dmat3& world_from_panorama, int width, int height);

}  // namespace livery
