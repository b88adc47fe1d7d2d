// Procedural environments as latitude-longitude maps (scene/look.h tells how a row and a column
// map to a direction), linear Rec.709.
#pragma once

#include <string>

#include <glm/vec3.hpp>

#include "core/image.h"

namespace livery::assets {

/// A dark photo studio: an overhead softbox along the car, two strip lights along its sides, a rim
/// light behind. `direction` is unit.
glm::dvec3 studio_radiance(const glm::dvec3& direction);

/// The CIE standard overcast sky over a ground of reflectance 0.2, scaled so that a level perfect
/// white diffuser has radiance 1.
glm::dvec3 overcast_radiance(const glm::dvec3& direction);

/// Averages 4 x 4 directions a pixel.
ImageF environment_map(glm::dvec3 (*radiance)(const glm::dvec3&), int width);

/// Averages over solid angle, of luminance.
struct EnvironmentAverages {
    double mean_radiance = 0.0;
    double level_white = 0.0;  ///< radiance of a level perfect white diffuser
};
EnvironmentAverages averages(const ImageF& map);

/// The bytes of a Radiance .hdr (RGBE, run-length encoded).
std::string hdr_bytes(const ImageF& image);

}  // namespace livery::assets
