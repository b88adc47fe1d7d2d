// Where a mirror ball stands, from its outline in a photograph.
#pragma once

#include <span>

#include <glm/vec2.hpp>

#include "calibration/environment/light_picture.h"
#include "calibration/sphere/sphere_outline.h"
#include "scene/view.h"

namespace livery {

/// The cone of tangents through points of the outline, by least squares of their angles from it
/// (Huber: points that lie off count less), whatever the perspective makes of the outline's shape.
/// The distance is what `diameter_mm` then asks for. `seen_fraction` is the part of the way around
/// that lies between neighbouring points no more than 60 degrees apart. Throws Refused for points
/// that are fewer than five, leave more than 240 degrees open or lie on no such outline, to
/// `largest_rms_px`.
OutlineFit fit_outline_points(const View& view,
                              std::span<const glm::dvec2> outline_px,
                              double diameter_mm,
                              double largest_rms_px);

/// Starts from `start` and looks for the steepest steps of brightness near its outline; the sphere
/// moves and its angle changes until it lies on them. Its diameter stays `start`'s, so that its
/// distance changes. What a ball mirrors inside of its outline has steps too: `start` must be right
/// to a twentieth of the ball. Throws Refused where there is no such outline.
OutlineFit find_ball_outline(const View& view, const LightPicture& picture, const Sphere& start);

}  // namespace livery
