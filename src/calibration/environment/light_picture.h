// Merged photographs as light, and where they say a direction's light is; panoramas, and how they
// were turned.
#pragma once

#include <functional>
#include <optional>
#include <span>

#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "calibration/captures/exposure_merge.h"
#include "core/image.h"

namespace livery {

/// What a picture says of light, and where it does not.
struct LightPicture {
    ImageF light;      ///< RGB, file units a second; where `saturated` at least so much
    Image8 saturated;  ///< 1 channel, 0 or 1: some channel is, in every exposure
    Image8 left_out;   ///< 1 channel, 0 or 1: by a mask
};

/// `clipped_light`: RGB, what a pixel that saturates in the shortest exposure has at least.
LightPicture light_of(const MergedPhotographs& merged, const glm::dvec3& clipped_light);

/// Where a picture shows a direction, and how finely.
struct SeenAt {
    glm::dvec2 pixel{0.0};
    double widest_rad = 0.0;  ///< the largest angle that a pixel spans there
    double finest_rad = 0.0;  ///< the smallest
    glm::dvec3 passed{1.0};   ///< share of the direction's light that reaches the camera, RGB
};
/// Of a unit direction in the world; nothing where the picture does not show it.
using SeeDirection = std::function<std::optional<SeenAt>(const glm::dvec3& direction)>;

/// Light between pixels' middles, bilinear.
struct SampledLight {
    glm::dvec3 light{0.0};
    double saturated = 0.0;  ///< share of it
};
/// Nothing outside of the picture or where one of the pixels is left out. `wraps`: the picture goes
/// all around, and its left edge is its right one.
std::optional<SampledLight> sample(const LightPicture& picture,
                                   const glm::dvec2& pixel,
                                   bool wraps);

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
