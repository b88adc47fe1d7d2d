#include "live/orbit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "core/error.h"

namespace livery {

namespace {

constexpr double kMargin = 1.06;

double size_of(const Bounds& bounds) {
    return std::max(glm::distance(bounds.low, bounds.high), 1e-6);
}

glm::dvec3 middle_of(const Bounds& bounds) { return 0.5 * (bounds.low + bounds.high); }

std::array<glm::dvec3, 8> corners_of(const Bounds& bounds) {
    std::array<glm::dvec3, 8> corners;
    for (unsigned k = 0; k < 8; ++k) {
        corners[k] = {(k & 1u) ? bounds.high.x : bounds.low.x,
                      (k & 2u) ? bounds.high.y : bounds.low.y,
                      (k & 4u) ? bounds.high.z : bounds.low.z};
    }
    return corners;
}

/// From the target toward the camera, unit.
glm::dvec3 direction_of(const Orbit& orbit) {
    return {std::cos(orbit.elevation_rad) * std::sin(orbit.azimuth_rad),
            std::sin(orbit.elevation_rad),
            std::cos(orbit.elevation_rad) * std::cos(orbit.azimuth_rad)};
}

struct Axes {
    glm::dvec3 right, down, back;
};
Axes axes_of(const Orbit& orbit) {
    const glm::dvec3 right(std::cos(orbit.azimuth_rad), 0.0, -std::sin(orbit.azimuth_rad));
    const glm::dvec3 back = direction_of(orbit);
    return {right, glm::cross(right, back), back};
}

/// Millimetres in the plane of the target that a pixel is wide.
double mm_a_pixel(const Orbit& orbit, int height_px) {
    check_argument(height_px > 0, fmt::format("orbit: a picture {} pixels high", height_px));
    return 2.0 * orbit.distance_mm * std::tan(0.5 * orbit.vertical_fov_rad) / height_px;
}

}  // namespace

Orbit default_orbit(const Bounds& bounds, double aspect) {
    Orbit orbit;
    orbit.azimuth_rad = std::atan2(1.0, 1.4);
    orbit.elevation_rad = std::atan2(0.45, std::hypot(1.0, 1.4));
    return fitted(orbit, bounds, aspect);
}

Orbit fitted(const Orbit& orbit, const Bounds& bounds, double aspect) {
    check_argument(aspect > 0.0, fmt::format("orbit: a picture of aspect {}", aspect));
    Orbit result = orbit;
    result.target_mm = middle_of(bounds);
    const Axes axes = axes_of(orbit);
    const double up = std::tan(0.5 * orbit.vertical_fov_rad) / kMargin;
    const double across = up * aspect;
    result.distance_mm = 0.05 * size_of(bounds);
    for (const glm::dvec3& corner : corners_of(bounds)) {
        const glm::dvec3 from_target = corner - result.target_mm;
        const double toward = glm::dot(from_target, axes.back);
        result.distance_mm =
            std::max({result.distance_mm,
                      toward + std::abs(glm::dot(from_target, axes.right)) / across,
                      toward + std::abs(glm::dot(from_target, axes.down)) / up});
    }
    return result;
}

Orbit turned(const Orbit& orbit, const glm::dvec2& drag_px, int height_px) {
    check_argument(height_px > 0, fmt::format("orbit: a picture {} pixels high", height_px));
    Orbit result = orbit;
    const double a_pixel = std::numbers::pi / height_px;
    result.azimuth_rad =
        std::remainder(orbit.azimuth_rad - a_pixel * drag_px.x, 2.0 * std::numbers::pi);
    result.elevation_rad = std::clamp(
        orbit.elevation_rad + a_pixel * drag_px.y, -kLargestElevation_rad, kLargestElevation_rad);
    return result;
}

Orbit zoomed(const Orbit& orbit, double steps, const Bounds& bounds) {
    Orbit result = orbit;
    const double size = size_of(bounds);
    result.distance_mm =
        std::clamp(orbit.distance_mm * std::pow(0.88, steps), 0.05 * size, 20.0 * size);
    return result;
}

Orbit zoomed(const Orbit& orbit,
             double steps,
             const Bounds& bounds,
             const glm::dvec2& at_px,
             const glm::ivec2& size_px) {
    const Orbit nearer = zoomed(orbit, steps, bounds);
    // What the pointer is on in the target's plane moves away from it by the change of scale
    const glm::dvec2 from_middle = at_px - 0.5 * glm::dvec2(size_px);
    return panned(
        nearer, from_middle * (1.0 - orbit.distance_mm / nearer.distance_mm), size_px.y, bounds);
}

Orbit panned(const Orbit& orbit, const glm::dvec2& drag_px, int height_px, const Bounds& bounds) {
    Orbit result = orbit;
    const Axes axes = axes_of(orbit);
    const double a_pixel = mm_a_pixel(orbit, height_px);
    result.target_mm -= a_pixel * (drag_px.x * axes.right + drag_px.y * axes.down);
    result.target_mm = glm::clamp(result.target_mm, bounds.low, bounds.high);
    return result;
}

glm::dvec3 eye_of(const Orbit& orbit) {
    return orbit.target_mm + orbit.distance_mm * direction_of(orbit);
}

View view_of(const Orbit& orbit, int width, int height) {
    return look_at(eye_of(orbit), orbit.target_mm, orbit.vertical_fov_rad, width, height);
}

View eye_view(const glm::dvec3& eye_mm, const Bounds& bounds, int width, int height) {
    constexpr double kDegree = std::numbers::pi / 180.0;
    // Any field of view gives the axes; the corners then say which one holds them
    const View axes = look_at(eye_mm, middle_of(bounds), 1.0, width, height);
    const double aspect = static_cast<double>(width) / height;
    double up = 0.0;
    for (const glm::dvec3& corner : corners_of(bounds)) {
        const glm::dvec3 x = axes.view_from_world * corner;
        const double depth = std::max(x.z, 1e-6);
        up = std::max({up, std::abs(x.y) / depth, std::abs(x.x) / depth / aspect});
    }
    const double fov = std::clamp(2.0 * std::atan(kMargin * up), kDegree, 100.0 * kDegree);
    return look_at(eye_mm, middle_of(bounds), fov, width, height);
}

}  // namespace livery
