// Non-additive projectors: drives from a measured table N(drive), by a start and Newton steps.
#pragma once

#include <array>
#include <vector>

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "compensation/compensation.h"

namespace livery {

/// rho for shaping the table's axes: the measured response where it runs from 0 to 255 without a
/// flat stretch, else 255 N^(1/2.2). Any rising curve serves; a close one keeps the table straight.
std::vector<float> shaper_of(const ResponseCurve& response);

/// Throws std::invalid_argument on a table of the wrong size, not finite, or of 1 or over 65
/// nodes a side. Takes about 0.2 s.
NonAdditive make_non_additive(const DriveTable& table,
                              const std::array<ResponseCurve, 3>& response);

/// N at a position, and how it changes with the position in that tetrahedron.
glm::vec3 n_at_position(const NonAdditive& table, const glm::vec3& position, glm::mat3* jacobian);

/// The position whose N is nearest to `n` (least squares); exact where N is reachable.
/// `shaped` is rho(n) / 255 per channel, clamped to [0, 1]. `residual` gets N(position) - n.
glm::vec3 position_of_n(const NonAdditive& table,
                        const glm::vec3& n,
                        const glm::vec3& shaped,
                        glm::vec3* residual);

/// Drive (0 to 255) of one channel at a position, given that channel's rho.
float drive_of_position(const NonAdditive& table,
                        const std::vector<float>& rho,
                        int channel,
                        float position);

/// Largest g at or under `upper` for which N = direction * g + offset can be shown; 0 when none.
double brightest_reachable(const NonAdditive& table,
                           const std::array<std::vector<float>, 3>& rho,
                           const glm::dvec3& direction,
                           const glm::dvec3& offset,
                           double upper);

/// Piecewise linear curve over equally spaced [0, 1], end values outside.
float look_up(const std::vector<float>& curve, float at);

/// How far from reachable still counts as reachable, in N: a fifth of an 8-bit level at white.
inline constexpr float kReachableN = 2e-3f;

}  // namespace livery
