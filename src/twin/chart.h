// A simulated photograph of a colour chart under daylight: how most people get a camera matrix.
#pragma once

#include <vector>

#include <glm/vec3.hpp>

#include "twin/description.h"

namespace livery {

/// The 24 patches of a ColorChecker under D65: linear camera RGB (any scale) and XYZ with Y = 1
/// for a perfect white.
struct ChartPhotograph {
    std::vector<glm::dvec3> camera_rgb;
    std::vector<glm::dvec3> xyz;
};

/// Spectral integration of the shipped patch reflectances with the camera's sensitivities.
ChartPhotograph photograph_chart_under_daylight(const CameraDescription& camera);

}  // namespace livery
