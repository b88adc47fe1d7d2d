// Non-additive projectors: drives from a measured table N(drive), by a start and Newton steps.
#pragma once

#include <array>
#include <vector>

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "compensation/compensation.h"

namespace livery {

/// rho for shaping the table's axes: the measured response where it rises from 0 to 255, else
/// 255 N^(1/2.2). Any rising curve serves; a close one keeps the table straight.
std::vector<float> shaper_of(const ResponseCurve& response);

/// Throws std::invalid_argument on a table of the wrong size, not finite, or of 1 or over 65
/// nodes a side. Takes about 0.2 s.
NonAdditive make_non_additive(const DriveTable& table,
                              const std::array<ResponseCurve, 3>& response);

/// N where the channels give `linear` light each, and its derivative in that tetrahedron.
glm::vec3 n_at_linear(const NonAdditive& table, const glm::vec3& linear, glm::mat3* jacobian);

/// The drives (0 to 255) whose N is nearest to `n`: exact where N is reachable, else near the
/// least-squares point. `residual` gets their N less the wanted one.
glm::vec3 drive_of_n(const NonAdditive& table, const glm::vec3& n, glm::vec3* residual);

/// Largest g at or under `upper` for which N = direction * g + offset can be shown; 0 when none.
double brightest_reachable(const NonAdditive& table,
                           const glm::dvec3& direction,
                           const glm::dvec3& offset,
                           double upper);

/// Piecewise linear curve over equally spaced [0, 1], end values outside.
float look_up(const std::vector<float>& curve, float at);

/// From the start grid: each solves the tetrahedron it is in exactly.
inline constexpr int kNewtonSteps = 3;

/// Near enough: a hundredth of a level where rho is steepest.
inline constexpr float kSolvedN = 1e-6f;

/// How far from reachable still counts as reachable, in N: a fifth of an 8-bit level at white.
inline constexpr float kReachableN = 2e-3f;

}  // namespace livery
