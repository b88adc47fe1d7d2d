// Lights as people think of them: where they stand, how strong, which colour.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

namespace livery {

/// Azimuth from -z toward +x (as an environment map's), elevation above the horizon; degrees,
/// because they are shown and typed.
struct Angles {
    double azimuth_deg = 0.0;    ///< in (-180, 180]
    double elevation_deg = 0.0;  ///< in [-90, 90]
};
/// Straight up and down have azimuth 0. Throws std::invalid_argument for a vector of no length.
Angles angles_of(const glm::dvec3& direction);
glm::dvec3 direction_of(const Angles& angles);  ///< unit

/// On the pad, which looks down on the product: x right (+x), y down (+z), the zenith in the
/// middle, the horizon at radius 1, the nadir at radius 2. Equal steps of elevation are equal steps
/// there.
glm::dvec2 pad_from_angles(const Angles& angles);
/// Beyond the rim the rim counts: the pad never sends a light below the horizon.
Angles angles_from_pad(const glm::dvec2& pad);

/// Where an eye or another point stands seen from a centre.
struct Polar {
    Angles angles;
    double distance_mm = 0.0;
};
Polar polar_of(const glm::dvec3& point_mm, const glm::dvec3& centre_mm);
glm::dvec3 point_of(const Polar& polar, const glm::dvec3& centre_mm);

/// The faintest strength that a slider shows; at it the light is off.
inline constexpr double kOffEv = -8.0;
/// 0.25 -> -2. What is not positive, or fainter than kOffEv: kOffEv.
double ev_of(double strength);
double strength_of(double ev);  ///< 0 at kOffEv and under it

/// A radiance as strength (its largest channel) and colour (largest channel 1). Black: strength 0,
/// white.
struct StrengthColour {
    double strength = 0.0;
    glm::dvec3 colour_rec709{1.0};
};
StrengthColour split_radiance(const glm::dvec3& radiance_rec709);

}  // namespace livery
