// What a paint's reflectance is, number by number, on the processor and by its shader.
#pragma once

#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "appearance/bsdf.h"
#include "appearance/directions.h"
#include "appearance/material.h"
#include "appearance/measured/measured_grid.h"
#include "appearance/measured/measured_reflectance.h"
#include "core/progress.h"
#include "gl/context.h"

namespace livery {

/// What the arithmetic is done in: float or double on the processor, or OpenGL's float.
enum class Precision { f32, f64, gpu };

struct ReflectanceSettings {
    Precision precision = Precision::f64;
    GlDevice gl = GlDevice::automatic;  ///< where Precision::gpu runs
    /// Directions and parameters are rounded to float first, which f32 and gpu always do: what then
    /// differs from them is rounding inside the model.
    bool round_inputs = false;
};

/// One value a pair, per steradian without the cosine, in the working space. Throws
/// std::invalid_argument for parameters out of range.
std::vector<glm::dvec3> reflectance_values(const Material& material,
                                           std::span<const DirectionPair> pairs,
                                           const ReflectanceSettings& settings,
                                           const Progress& progress = {});

/// The same of measured reflectance: in float and on the GPU, of the grid that a GPU draws it from
/// (appearance/measured/measured_grid.h).
std::vector<glm::dvec3> reflectance_values(const MeasuredReflectance& measured,
                                           std::span<const DirectionPair> pairs,
                                           const ReflectanceSettings& settings,
                                           const Progress& progress = {});

/// Directional albedo for each direction toward the eye, in the working space. In float: the
/// double's, and the mean difference of the two over the model's own samples.
std::vector<glm::dvec3> albedo_values(const Material& material,
                                      std::span<const glm::dvec3> wo,
                                      const ReflectanceSettings& settings,
                                      const Progress& progress = {});
/// Of measured reflectance, by quadrature over the half vector.
std::vector<glm::dvec3> albedo_values(const MeasuredReflectance& measured,
                                      std::span<const glm::dvec3> wo,
                                      const ReflectanceSettings& settings,
                                      const Progress& progress = {});

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
