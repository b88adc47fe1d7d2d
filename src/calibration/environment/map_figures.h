// What a map of the light says in numbers.
#pragma once

#include <cstddef>
#include <vector>

#include <glm/vec3.hpp>

#include "calibration/environment/radiance_map.h"

namespace livery {

/// Light that is brighter than the shortest exposure can tell.
struct ClippedLamp {
    glm::dvec3 direction{0.0};  ///< unit, in the world: the middle of its light
    double solid_angle_sr = 0.0;
    double luminance = 0.0;  ///< of the map, mean: at least so much
    /// Of the light on a surface that faces it, at least: for each time that the lamp is as bright
    /// again as the map says, that surface gets this share more.
    double irradiance_share = 0.0;
    std::size_t texels = 0;
};

/// Neighbouring clipped texels together, those that give the most light first. `radiance` is in
/// Rec.709.
std::vector<ClippedLamp> clipped_lamps(const RadianceMap& map);

/// Luminance of a perfect white diffuser that faces where it is brightest.
double brightest_white(const ImageF& radiance_rec709);

/// Between the brightest texel and the darkest hundredth of what is seen, in factors of two.
double dynamic_range_stops(const RadianceMap& map);

/// Shares of all directions.
struct Coverage {
    double covered = 0.0;  ///< seen by pixels that span at most 2 degrees
    double coarse = 0.0;   ///< seen by wider ones: right on the average, not in detail
};
Coverage coverage_of(const RadianceMap& map);

}  // namespace livery
