// Turned and lofted solids: wheels, mirrors, the sphere.
#pragma once

#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "part_mesh.h"

namespace livery::assets {

/// Turns a profile (x: radius, y: along the axis z) about z. Profiles run with the solid on their
/// left when the radius points right and z points up; a closed one is joined at its end. Corners
/// over 35 degrees stay sharp. A sector turns from `from_rad` to `to_rad` and has flat ends where
/// the profile is closed.
PartMesh revolve(const std::vector<glm::dvec2>& profile,
                 bool closed,
                 int segments,
                 double from_rad = 0.0,
                 double to_rad = 6.283185307179586);

/// Joins loops of equal length, each counter-clockwise seen against the direction of the loft.
/// Smooth along and around, with flat ends.
PartMesh loft(const std::vector<std::vector<glm::dvec3>>& loops);

PartMesh sphere(double radius_mm, int rings);

}  // namespace livery::assets
