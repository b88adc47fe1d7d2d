// From the light on the camera's pixels to the numbers in its file, and a photograph of a colour
// chart by it.
#pragma once

#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

#include "core/image.h"
#include "twin/description.h"

namespace livery {

/// A picture displaced by up to `shift_px`: mostly sideways, more on one side than on the other, as
/// a camera that sags on its tripod moves it. Bilinear.
ImageF shifted(const ImageF& light, double shift_px);

/// A picture displaced by so many pixels. Bilinear.
ImageF moved(const ImageF& light, double right_px, double down_px);

/// `flare` of the light of every pixel spread over its surroundings.
ImageF with_flare(const ImageF& light, double flare, double radius_of_width);

/// Exposes, adds noise, clips, encodes. `units_per_s` is linear light in file units a second;
/// `photograph` counts photographs, so that each has noise of its own.
ImageF develop(const CameraDescription& camera,
               const ImageF& units_per_s,
               double exposure_s,
               std::uint64_t seed,
               std::uint32_t photograph);

/// Where the file's values stop.
double saturates_at(const CameraDescription& camera);
/// The file's value for no light.
double black_level(const CameraDescription& camera);

/// The 24 patches of a ColorChecker under D65: linear camera RGB (any scale) and XYZ with Y = 1
/// for a perfect white.
struct ChartPhotograph {
    std::vector<glm::dvec3> camera_rgb;
    std::vector<glm::dvec3> xyz;
};

/// Spectral integration of the shipped patch reflectances with the camera's sensitivities.
ChartPhotograph photograph_chart_under_daylight(const CameraDescription& camera);

}  // namespace livery
