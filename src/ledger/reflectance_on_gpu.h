// Reflectance evaluated by its shader (shaders/bsdf) for given directions.
#pragma once

#include <span>
#include <vector>

#include "appearance/bsdf.h"
#include "appearance/measured/measured_grid.h"
#include "core/progress.h"
#include "gl/context.h"
#include "ledger/reflectance_values.h"

namespace livery {

/// In the working space, one value a pair. Makes a context of its own and leaves none current.
std::vector<glm::dvec3> reflectance_on_gpu(ReflectanceModel model,
                                           const BsdfParameters& parameters,
                                           std::span<const DirectionPair> pairs,
                                           GlDevice device,
                                           const Progress& progress = {});
/// The same of measured reflectance, drawn from its grid.
std::vector<glm::dvec3> reflectance_on_gpu(const MeasuredGrid& grid,
                                           std::span<const DirectionPair> pairs,
                                           GlDevice device,
                                           const Progress& progress = {});

}  // namespace livery
