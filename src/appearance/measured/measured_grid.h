// Measured reflectance on one regular grid, as a graphics card draws it, and what that costs in
// accuracy.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "appearance/directions.h"
#include "appearance/measured/measured_reflectance.h"
#include "core/progress.h"

namespace livery {

/// Nodes along theta_h, theta_d and phi_d (shaders/bsdf/half_difference.glsl).
struct MeasuredGridSize {
    int theta_h = 64, theta_d = 32, phi_d = 32;
};

/// Logarithms, between which values are linear: lobes fall over orders of magnitude from one node
/// to the next.
struct MeasuredGrid {
    MeasuredGridSize size;
    /// log2(value + kMeasuredGridFloor) of X, Y, Z (which no light makes negative), four floats a
    /// node (the last 0): phi_d runs fastest, then theta_h, then theta_d, so that one theta_d is
    /// one layer of a texture.
    std::vector<float> texels;
};

/// Per steradian; darker is the same.
inline constexpr float kMeasuredGridFloor = 1e-5f;

/// Throws Cancelled.
MeasuredGrid resampled(const MeasuredReflectance& measured,
                       MeasuredGridSize size = {},
                       const Progress& progress = {});

/// In the working space as evaluate() of what was measured, by the shader's own steps, in float.
glm::vec3 evaluate(const MeasuredGrid& grid, glm::vec3 wi, glm::vec3 wo);
/// The same steps in double.
glm::dvec3 evaluate_in_double(const MeasuredGrid& grid, glm::dvec3 wi, glm::dvec3 wo);

/// GLSL to put after `#version`: `vec3 measured_eval(sampler2DArray grid,
/// vec3 wi, vec3 wo)`. Throws FileError when the shipped sources are not found.
std::string measured_glsl();

/// How far one reflectance is from another.
struct ReflectanceDifference {
    /// Of the luminance, relative to the truth: median and 95th percentile over pairs of
    /// directions, both cosines above 0.17 (80 degrees), even in solid angle.
    double relative_median = 0.0, relative_p95 = 0.0;
    /// CIEDE2000 over a sphere seen from far away under four lights, 10, 35, 60 and 90 degrees from
    /// the eye, with white a perfect diffuser that faces the light; brighter is as bright.
    double de00_mean = 0.0, de00_p95 = 0.0;
};

using ReflectanceFunction = std::function<glm::dvec3(const glm::dvec3& wi, const glm::dvec3& wo)>;
/// What a truth shows to difference_of(), for many values to be held against.
struct DifferenceTruth {
    std::vector<DirectionPair> pairs;  ///< of the relative differences
    std::vector<double> luminances;
    std::vector<DirectionPair> sphere_pairs;
    std::vector<glm::dvec3> sphere_labs;
};
DifferenceTruth difference_truth(const ReflectanceFunction& truth);

/// Both give values in the working space.
ReflectanceDifference difference_of(const ReflectanceFunction& value, const DifferenceTruth& truth);
ReflectanceDifference difference_of(const ReflectanceFunction& value,
                                    const ReflectanceFunction& truth);
/// L*a*b* of a pixel of the sphere by its reflectance and the cosine of its light.
glm::dvec3 lab_on_sphere(const glm::dvec3& reflectance, double cosine);

/// What the grid loses.
ReflectanceDifference resampling_error(const MeasuredGrid& grid,
                                       const MeasuredReflectance& measured);

/// The pairs of directions of that sphere's lit pixels.
std::vector<DirectionPair> lit_sphere_pairs(int pixels_across = 48);

}  // namespace livery
