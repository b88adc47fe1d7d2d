// What a mirror ball shows of the light around it: geometry and reflectance.
#pragma once

#include "calibration/environment/light_picture.h"
#include "calibration/sphere/tangent_cone.h"
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

}  // namespace livery
