// Reflectance in the plane of light and normal, as a curve to look at.
#pragma once

#include <vector>

#include <glm/vec3.hpp>

#include "appearance/material.h"

namespace livery {

struct LobePoint {
    double theta_o_rad = 0.0;  ///< of the eye: positive on the mirror direction's side
    glm::dvec3 value{0.0};     ///< per steradian, working space
};

/// From horizon to horizon, for light from theta_i (0 to pi/2) at the side where angles are
/// negative; closest around the mirror direction, where a lobe of any width has its points. With a
/// grain the plane lies along it. Throws as bsdf_of().
std::vector<LobePoint> lobe_curve(const Material& material, double theta_i_rad);

}  // namespace livery
