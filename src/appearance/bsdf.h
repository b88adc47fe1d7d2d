// What a surface does with light: one value per pair of directions, samples and their density.
//
// Local coordinates: z is the normal, x the tangent. wi points toward the light, wo toward the eye,
// both unit. Values are per steradian without the cosine, in the working space, and 0 when either
// direction is below the horizon.
#pragma once

#include <string>
#include <vector>

#include "appearance/bsdf_source.h"
#include "appearance/material.h"

namespace livery {

using BsdfParameters = f32::BsdfParameters;
using BsdfEnvironment = f32::BsdfEnvironment;

/// A material's parameters, converted to the working space. Throws std::invalid_argument that names
/// a parameter out of range (a colour outside [0, 1] in the working space included).
f32::BsdfParameters parameters_of(const Material& material);
f64::BsdfParameters parameters_of_f64(const Material& material);
f32::BsdfParameters rounded(const f64::BsdfParameters& parameters);
f64::BsdfParameters widened(const f32::BsdfParameters& parameters);

glm::vec3 evaluate(ReflectanceModel model,
                   const f32::BsdfParameters& parameters,
                   glm::vec3 wi,
                   glm::vec3 wo);
glm::dvec3 evaluate(ReflectanceModel model,
                    const f64::BsdfParameters& parameters,
                    glm::dvec3 wi,
                    glm::dvec3 wo);

/// A direction wi for light that leaves along wo; `u` in [0, 1)^3. May lie below the horizon: a
/// sample without a value, which counts.
glm::vec3 sample(ReflectanceModel model,
                 const f32::BsdfParameters& parameters,
                 glm::vec3 wo,
                 glm::vec3 u);
glm::dvec3 sample(ReflectanceModel model,
                  const f64::BsdfParameters& parameters,
                  glm::dvec3 wo,
                  glm::dvec3 u);

/// Density of `sample` over solid angle, at the directions above the horizon.
float pdf(ReflectanceModel model,
          const f32::BsdfParameters& parameters,
          glm::vec3 wi,
          glm::vec3 wo);
double pdf(ReflectanceModel model,
           const f64::BsdfParameters& parameters,
           glm::dvec3 wi,
           glm::dvec3 wo);

/// Weights of the parts of the light from all around (shaders/bsdf/parameters.glsl).
f32::BsdfEnvironment environment_weights(ReflectanceModel model,
                                         const f32::BsdfParameters& parameters,
                                         float mu);

/// Share of the light leaving along wo under uniform light, by quadrature of evaluate() in each
/// lobe's own coordinates: `points` a side for each lobe.
glm::dvec3 directional_albedo(ReflectanceModel model,
                              const f64::BsdfParameters& parameters,
                              glm::dvec3 wo,
                              int points = 192);

/// Shader text to put after `#version`: the model's functions under the names bsdf_eval,
/// bsdf_sample, bsdf_pdf, bsdf_environment, with struct BsdfParameters, bsdf_widen and what they
/// need. Of measured reflectance bsdf_eval alone, which reads the sampler2DArray `u_measured`
/// (measured_grid.h). Throws FileError when the shipped sources are not found.
std::string bsdf_glsl(ReflectanceModel model);

/// The fields of the struct that a model prepares, as its shader file declares them: where each of
/// PreparedPaint::numbers goes. Throws std::logic_error where the file has no such struct.
struct PreparedField {
    std::string name;   ///< "coat.f0"
    std::size_t count;  ///< of numbers: 1 or 3
};
std::vector<PreparedField> prepared_fields(ReflectanceModel model);

}  // namespace livery
