// Photographs of a painted sphere, one lamp at a time -> the paint's reflectance.
//
// Seen by a camera that stands still, each lamp lays one angle between light and eye over all
// normals of the sphere: lamps from beside the camera to behind the sphere cover what an isotropic
// paint can show (Marschner et al. 1999; Matusik et al. 2003).
#pragma once

#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "appearance/directions.h"
#include "calibration/sphere/sphere_outline.h"
#include "core/progress.h"

namespace livery {

/// Throws Refused when no lamp lights what the camera sees of the sphere, or all of that is
/// saturated.
void check_lit(const View& view, const Sphere& sphere, std::span<const LitSphere> lit);

/// How the camera answers to a lamp: the file units a second of each channel are this times the
/// reflectance per steradian, the cosine and 1 / mm^2 of the lamp's distance.
struct LampResponse {
    glm::dvec3 units{0.0};
    double rms = 0.0;  ///< of the white sphere's pixels to a matte sphere's, relative
};

/// Of a matte white sphere, up to 60 degrees from light and eye: few whites are matte beyond.
/// Throws Refused when too little of it is lit, or it is saturated there.
LampResponse lamp_response(const View& view,
                           const Sphere& sphere,
                           const LitSphere& white,
                           const glm::dvec3& reflectance);

/// Steps of the half vector's angle (with its root), of the light's angle to it and, up to a right
/// angle, of its azimuth: a paint without grain or handedness is the same beyond, and with light
/// and eye exchanged.
struct SphereGrid {
    int theta_h = 64, theta_d = 32, phi_d = 16;
};

/// A paint's reflectance to the camera's red, green and blue: a perfect diffuser has 1 / pi.
struct SphereReflectance {
    std::vector<DirectionPair> pairs;  ///< of each cell seen: the mean of its pixels' angles
    std::vector<glm::dvec3> values;    ///< per steradian
    double coverage = 0.0;  ///< of the pairs of directions up to 80 degrees, even in solid angle
    /// How far several looks at one cell (by another lamp, on another side of the sphere) are from
    /// their mean, relative to it: root mean square and median.
    double residual = 0.0, residual_median = 0.0;
    std::size_t pixels = 0;     ///< used, over all lamps
    std::size_t saturated = 0;  ///< left out: in every exposure
    std::size_t dark = 0;       ///< left out: not clearly over what the lens scatters
};

/// Takes what is seen and lit up to 80 degrees from the normal and over twice as bright as the
/// cloth around the sphere, which tells what the lens scatters and is taken off. `lamps` has the
/// response of each of `lit`. Throws Refused when no cloth is in the picture or nothing is left.
SphereReflectance sphere_reflectance(const View& view,
                                     const Sphere& sphere,
                                     std::span<const LitSphere> lit,
                                     std::span<const LampResponse> lamps,
                                     const SphereGrid& grid = {},
                                     const Progress& progress = {});

}  // namespace livery
