// Where a camera's pixels lie in a plane.
#pragma once

#include <array>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "calibration/captures/exposure_merge.h"
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

/// RGB, file units a second: what the spot adds to the room's light and to the projector's black.
/// NaN where every photograph of either is saturated. Throws std::invalid_argument for pictures of
/// two sizes.
ImageF added_light(const MergedPhotographs& lit, const MergedPhotographs& black);

struct SpotOfLight {
    glm::dvec2 centre_mm{0.0};  ///< of its light, in the plane
    /// Diameter of the disc around the centre that holds half of its power, of each channel.
    std::array<double, 3> diameter_mm{};
    /// Sum of light times area over the spot, file units mm^2 a second; 0: hardly any light in this
    /// channel, under a hundredth of the strongest.
    std::array<double, 3> power{};
    double radius_mm = 0.0;  ///< of the disc in which it was looked at: six times half the diameter
    double reach_mm = 0.0;   ///< from the centre to the nearest edge of the picture
    double pixel_mm = 0.0;   ///< root of a pixel's area there
};

/// Throws Refused: no spot over the noise, one that is clipped in every photograph, one that is not
/// wholly in the picture. What lies beyond `radius_mm` (the lens's scatter, noise) does not count.
SpotOfLight spot_of_light(const PlanePixels& pixels, const ImageF& light);

/// Centre of the light (all channels) within the spot's disc; NaN counts as none.
glm::dvec2 centre_of_light(const PlanePixels& pixels,
                           const ImageF& light,
                           const glm::dvec2& around_mm,
                           double radius_mm);

}  // namespace livery
