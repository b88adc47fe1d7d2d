// Photographs of a mirror ball or a panorama -> a latitude-longitude map of the light from all
// directions (scene/look.h has the map's convention).
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "calibration/environment/light_picture.h"
#include "core/image.h"
#include "core/progress.h"

namespace livery {

/// Latitude-longitude, in the world. One channel but for `radiance`.
struct RadianceMap {
    ImageF radiance;    ///< RGB, as the pictures' light; 0 where nothing is seen
    ImageF seen;        ///< share of the texel that some picture shows
    ImageF widest_rad;  ///< the largest angle that a pixel spans there; 0 where nothing is seen
    ImageF saturated;   ///< share of the texel's light that is clipped: more than it says
};

/// Integrates each texel over what the picture's pixels say of it: looks from each of the texel's
/// parts, equal in solid angle and finer than the pixels, back into the picture. A map so made has
/// no holes, however many texels a pixel covers, and no pixel is skipped, however many a texel
/// covers. `width`: of the map, twice its height.
RadianceMap gather(const LightPicture& picture,
                   const SeeDirection& see,
                   bool wraps,
                   int width,
                   const Progress& progress = {});

/// Several maps of one light: means weighted by how finely each sees, the inverse square of what a
/// pixel spans, and where one is clipped and another is not, that one alone.
RadianceMap merge(std::span<const RadianceMap> maps);

/// Toward the middle of a texel, and the solid angle of the texels of a row.
glm::dvec3 texel_direction(const ImageF& map, int x, int y);
double texel_sr(const ImageF& map, int y);

/// Fills texels of which less than half is seen with the smoothest continuation of what surrounds
/// them: the harmonic function on the sphere (Laplace's equation in finite volumes, conjugate
/// gradients), which is never brighter or darker than its surroundings. A lamp at a hole's edge is
/// not continued: there 3 times the edge's median, channel by channel, is the most. Gives the share
/// of all directions that was filled. Throws Refused when nothing is seen.
double fill_unseen(RadianceMap& map);

}  // namespace livery
