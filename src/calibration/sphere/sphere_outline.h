// Where a sphere stands, from its outline in photographs, and the cone of rays that touch it.
#pragma once

#include <optional>
#include <span>

#include <glm/vec3.hpp>

#include "calibration/captures/exposure_merge.h"
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

/// A sphere in the light of one lamp.
struct LitSphere {
    MergedPhotographs picture;
    glm::dvec3 light_mm{0.0};
};

struct OutlineFit {
    Sphere sphere;
    double rms_px = 0.0;         ///< of the edges to the outline
    double seen_fraction = 0.0;  ///< of the outline's directions in which an edge was found
};

/// Moves the centre across the line of sight and changes the diameter until the outline lies on the
/// edges. An outline cannot tell a larger sphere from a nearer one: the distance stays `start`'s.
/// `view` sees what the pictures show. Throws Refused when there is no such outline.
OutlineFit fit_outline(const View& view, const Sphere& start, std::span<const LitSphere> lit);

/// The box around a sphere's outline, in pixels; may reach outside of the picture. Nothing for a
/// sphere that is not wholly in front of the view.
struct OutlineBox {
    double left = 0.0, top = 0.0, right = 0.0, bottom = 0.0;
};
std::optional<OutlineBox> outline_box(const View& view, const Sphere& sphere);

}  // namespace livery
