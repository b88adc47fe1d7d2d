#include "studio/light/light_values.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "core/angles.h"
#include "core/error.h"

namespace livery {

Angles angles_of(const glm::dvec3& direction) {
    const double across = std::hypot(direction.x, direction.z);
    check_argument(across > 0.0 || direction.y != 0.0, "a direction of no length has no angles");
    Angles angles;
    if (across > 1e-9 * std::abs(direction.y)) {
        angles.azimuth_deg = kDegreesPerRadian * std::atan2(direction.x, -direction.z);
    }
    angles.elevation_deg = kDegreesPerRadian * std::atan2(direction.y, across);
    return angles;
}

glm::dvec3 direction_of(const Angles& angles) {
    const double azimuth = angles.azimuth_deg / kDegreesPerRadian;
    const double elevation = angles.elevation_deg / kDegreesPerRadian;
    return {std::cos(elevation) * std::sin(azimuth),
            std::sin(elevation),
            -std::cos(elevation) * std::cos(azimuth)};
}

glm::dvec2 pad_from_angles(const Angles& angles) {
    const double radius = (90.0 - angles.elevation_deg) / 90.0;
    const double azimuth = angles.azimuth_deg / kDegreesPerRadian;
    return {radius * std::sin(azimuth), -radius * std::cos(azimuth)};
}

Angles angles_from_pad(const glm::dvec2& pad) {
    const double radius = glm::length(pad);
    Angles angles;
    if (radius > 1e-6) angles.azimuth_deg = kDegreesPerRadian * std::atan2(pad.x, -pad.y);
    angles.elevation_deg = 90.0 * (1.0 - std::min(radius, 1.0));
    return angles;
}

Polar polar_of(const glm::dvec3& point_mm, const glm::dvec3& centre_mm) {
    const glm::dvec3 offset = point_mm - centre_mm;
    Polar polar;
    polar.distance_mm = glm::length(offset);
    if (polar.distance_mm > 0.0) polar.angles = angles_of(offset);
    return polar;
}

glm::dvec3 point_of(const Polar& polar, const glm::dvec3& centre_mm) {
    return centre_mm + polar.distance_mm * direction_of(polar.angles);
}

double ev_of(double strength) {
    return strength > 0.0 ? std::max(std::log2(strength), kOffEv) : kOffEv;
}

double strength_of(double ev) { return ev <= kOffEv ? 0.0 : std::exp2(ev); }

StrengthColour split_radiance(const glm::dvec3& radiance_rec709) {
    const double largest = std::max({radiance_rec709.x, radiance_rec709.y, radiance_rec709.z});
    if (largest <= 0.0) return {};
    return {largest, radiance_rec709 / largest};
}

}  // namespace livery
