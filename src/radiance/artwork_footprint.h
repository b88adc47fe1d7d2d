// What of an artwork a projector's pixel covers.
#pragma once

#include <cstdint>
#include <vector>

#include "radiance/surface_map.h"
#include "scene/artwork_coats.h"
#include "scene/view.h"

namespace livery {

/// Sides of a pixel where its rays meet the surface's tangent plane, in mm. Where the surface turns
/// away from the view they grow no further than to thirty times a pixel that faces it.
struct Footprint {
    glm::dvec3 a{0.0}, b{0.0};
};
Footprint footprint_of(const View& view,
                       std::uint32_t pixel,
                       const glm::dvec3& position_mm,
                       const glm::dvec3& normal);
/// Of every fragment of a part.
std::vector<Footprint> footprints_of(const View& view, const SurfaceMap& map, std::size_t part);

/// A footprint in an artwork's plane, or along the mesh's texture coordinates.
struct FlatFootprint {
    glm::dvec2 at{0.0}, a{0.0}, b{0.0};
};
/// `plane` is plane_of() the artwork's place.
FlatFootprint flat_footprint(const Mesh& mesh,
                             const SurfaceMap& map,
                             std::size_t fragment,
                             const Footprint& footprint,
                             const PartArtwork& artwork,
                             const ArtworkPlane& plane);

}  // namespace livery
