// Colour photographs -> compensation (equations 3 to 9 of the paper, and the robust variant).
#pragma once

#include <vector>

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "calibration/settings.h"
#include "core/progress.h"
#include "scene/colour_calibration.h"

namespace livery {

/// `captures` holds the six roles, more than one photograph a role is averaged, and `colors-N`
/// mosaics where the projector is not additive (`patterns` says what each showed: gray-levels and
/// the mosaics are needed there). Throws Refused with why and fix, FileError for captures that do
/// not fit together, std::invalid_argument for settings
/// and patterns that make no sense. What comes back is not sealed yet.
ColourCalibration calibrate_colour(const std::vector<RoledPhotograph>& captures,
                                   const std::vector<Pattern>& patterns,
                                   const ProjectorToCamera& map,
                                   const CalibrationSettings& settings,
                                   const Progress& progress = {});

/// Camera matrix from a colour chart lit by the projector's white (its colours' XYZ under that
/// light must be known) or, as most do, under daylight: for comparison. Least squares of relative
/// errors.
glm::dmat3 fit_camera_matrix(const std::vector<glm::dvec3>& camera_rgb,
                             const std::vector<glm::dvec3>& xyz);

/// Additivity error over which the additive model is warned about, and refused.
inline constexpr double kAdditivityWarning = 0.02, kAdditivityLimit = 0.05;

}  // namespace livery
