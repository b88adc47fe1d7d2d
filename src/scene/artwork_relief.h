// Relief: a picture of normals that tilts the surface of a part.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "scene/artwork_coats.h"

namespace livery {

/// Along which a relief's slopes count, on the surface: unit, square to its normal and to each
/// other.
struct ReliefFrame {
    glm::dvec3 right{1.0, 0.0, 0.0}, up{0.0, 1.0, 0.0};
};
/// `tangent` as in Mesh: of a relief along the mesh's texture coordinates.
ReliefFrame relief_frame(const PartArtwork& relief,
                         const glm::dvec3& normal,
                         const glm::dvec4& tangent);

/// The tilt of normals in a footprint: mean slopes (a normal is x / z, y / z of its picture's) and
/// their mean square around that mean. Linear in what is averaged, so it holds at every distance
/// (Olano and Baker, LEAN mapping, 2010).
struct ReliefTilt {
    glm::dvec2 slope{0.0};
    double variance = 0.0;  ///< both directions together
};
/// Of a mean of picture_layers(): slopes, their squares together, cover.
ReliefTilt tilt_of(const PartArtwork& relief, const glm::dvec4& mean);
/// At a single point of the picture.
ReliefTilt tilt_at(const PartArtwork& relief, const ArtworkPoint& point);

/// A unit normal with those slopes on it.
glm::dvec3 tilted(const glm::dvec3& normal, const ReliefFrame& frame, const glm::dvec2& slope);

}  // namespace livery
