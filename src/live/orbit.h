// The camera of the preview: around a product, by azimuth, elevation and distance. Pure functions.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "mesh/mesh.h"
#include "scene/view.h"

namespace livery {

/// Looks at `target_mm` from `distance_mm` away; world y is up in the picture.
struct Orbit {
    double azimuth_rad = 0.0;    ///< 0: from +z; grows toward +x
    double elevation_rad = 0.0;  ///< positive: from above
    double distance_mm = 1000.0;
    glm::dvec3 target_mm{0.0};
    double vertical_fov_rad = 0.42;  ///< some 24 degrees, as products are photographed
};

/// Elevation stays this far from straight up and down, where azimuth would lose its meaning.
inline constexpr double kLargestElevation_rad = 1.5;

/// The whole of the product from its front quarter, as default_eye_mm sees it.
Orbit default_orbit(const Bounds& bounds, double aspect);

/// The same direction, as near as the whole of the product allows with a margin of 6%. `aspect`
/// is width over height. Throws std::invalid_argument when that is not positive.
Orbit fitted(const Orbit& orbit, const Bounds& bounds, double aspect);

/// The pointer moved: the product turns under it, half a turn over the picture's height.
Orbit turned(const Orbit& orbit, const glm::dvec2& drag_px, int height_px);

/// Positive steps (of a wheel) come nearer, 12% each; between a twentieth of the product's size
/// and twenty times it. With `at_px`, what is under the pointer stays there.
Orbit zoomed(const Orbit& orbit, double steps, const Bounds& bounds);
Orbit zoomed(const Orbit& orbit,
             double steps,
             const Bounds& bounds,
             const glm::dvec2& at_px,
             const glm::ivec2& size_px);

/// The target follows the pointer; it stays inside the product's bounds.
Orbit panned(const Orbit& orbit, const glm::dvec2& drag_px, int height_px, const Bounds& bounds);

glm::dvec3 eye_of(const Orbit& orbit);  ///< where the camera stands, mm
View view_of(const Orbit& orbit, int width, int height);

/// What somebody at `eye_mm` sees who looks at the product's middle: the whole of it with a margin
/// of 6%, so the field of view follows the distance (a degree at least, 100 at most).
View eye_view(const glm::dvec3& eye_mm, const Bounds& bounds, int width, int height);

}  // namespace livery
