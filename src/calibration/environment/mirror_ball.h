// What a mirror ball shows of the light around it: where it stands, from its outline in a
// photograph, its geometry and its reflectance.
#pragma once

#include <span>

#include <glm/vec2.hpp>

#include "calibration/environment/light_picture.h"
#include "calibration/sphere/sphere_outline.h"
#include "scene/view.h"

namespace livery {

struct MirrorBall {
    Sphere sphere;
    glm::dvec3 reflectance{1.0};  ///< RGB, share of the light, at normal incidence
    /// It grows toward grazing incidence as Schlick (1994) says, which metals do within some
    /// percent; else it is the same everywhere.
    bool fresnel = true;
    /// What stands where the camera does hides directions up to so far from it, seen from the ball.
    double camera_rad = 0.0;
};

/// Where a camera sees directions in the ball, light from far away taken for granted. A direction
/// is mirrored by one place of a sphere alone: in the plane of ball, eye and direction, at the
/// angle alpha from the eye, where 2 alpha + delta(alpha) is the direction's angle from it and
/// delta the camera's ray's (Alhazen's problem with one point at infinity; Newton, bracketed). Not
/// seen are the cone behind the ball, whatever mirrors less than 1.5 px inside of the outline,
/// where pixels mix with the background, and what is around the camera. Throws
/// std::invalid_argument for a camera inside the ball.
SeeDirection seen_in_ball(const View& view, const MirrorBall& ball);

/// Half the angle of the cone behind the ball in which no mirror of its kind shows anything.
double hidden_behind_rad(const View& view, const Sphere& sphere);

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
