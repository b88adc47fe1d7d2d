// A sphere's outline as a camera sees it: the cone of rays that touch it.
#pragma once

#include <span>

#include <glm/vec3.hpp>

#include "scene/view.h"

namespace livery {

struct Sphere {
    glm::dvec3 centre_mm{0.0};
    double diameter_mm = 0.0;
};

/// The cone of tangents from the eye: its axis and half its opening angle.
struct TangentCone {
    glm::dvec3 axis, right, down;  ///< unit, orthogonal, in the world
    double distance_mm = 0.0;      ///< from the eye to the sphere's middle
    double angle_rad = 0.0;
};

/// Throws std::invalid_argument for a camera inside the sphere or a sphere without size.
TangentCone cone_of(const View& view, const Sphere& sphere);
Sphere sphere_of(const View& view, const TangentCone& cone);

/// The unit vector across the axis at a turn from `right` to `down`.
glm::dvec3 around(const TangentCone& cone, double turn_rad);

/// A ray of the outline as the cone sees it: how far around the axis, and how far from it.
struct ConeEdge {
    double turn_rad = 0.0;
    double angle_rad = 0.0;
};
/// Of a ray's direction from the eye (unit). `turn_rad` in [0, 2 pi).
ConeEdge edge_of(const TangentCone& cone, const glm::dvec3& direction);

/// Turns the axis and opens the cone until it passes through the edges, those that lie off counting
/// less (Huber). The distance stays. Gives their root mean square afterwards, radians.
double move_cone(std::span<const ConeEdge> edges, double outlier_rad, TangentCone& cone);

}  // namespace livery
