// What a model is fitted to: reflectance at many pairs of directions.
#pragma once

#include <functional>
#include <vector>

#include <glm/vec3.hpp>

#include "appearance/directions.h"
#include "appearance/measured/measured_grid.h"

namespace livery {

/// Reflectance at pairs of directions, in the working space, per steradian.
struct FitSamples {
    std::vector<DirectionPair> pairs;
    std::vector<glm::dvec3> values_working;
};

/// How densely half/difference space is sampled: theta_h in steps of its root.
struct FitGridSize {
    int theta_h = 90, theta_d = 24, phi_d = 24;
};

/// Of the pairs on the grid those with both angles up to 80 degrees that were measured: beyond it
/// gonioreflectometers see the lamp.
FitSamples fit_samples(const ReflectanceFunction& truth_working,
                       const std::function<bool(const DirectionPair&)>& is_measured,
                       FitGridSize size = {});

}  // namespace livery
