// What a search makes small: how far a paint is from what was measured, as a list of numbers.
#pragma once

#include <cstddef>
#include <functional>

#include "appearance/bound_bsdf.h"
#include "appearance/fit/fit_samples.h"
#include "appearance/measured/measured_grid.h"

namespace livery {

struct Residuals {
    std::size_t count = 0;
    std::function<void(const BoundBsdf<double, glm::dvec3>& paint, double* values)> write;
};

/// What residuals are differences of. The logarithm weighs what is bright and what is dark alike;
/// the cube root, as an eye does, brightness a little more.
enum class Metric {
    logarithm,  ///< log(f cos + 0.01)
    cube_root   ///< (f cos)^(1/3)
};

/// Of every `stride`th sample; the samples must stay.
Residuals sample_residuals(const FitSamples& samples, Metric metric, std::size_t stride);

/// Of every so manieth pixel of the lit sphere, and of every so manieth sample.
struct SphereStrides {
    std::size_t pixels = 1, samples = 1;
};
/// What is seen on the lit sphere: the sum of their squares is nearly the mean CIEDE2000, with a
/// tenth of its mean square, for which the worst pixels count, and a share of the logarithms'
/// mean square, for what the sphere does not show. Truth and samples must stay.
Residuals sphere_residuals(const DifferenceTruth& truth,
                           const FitSamples& samples,
                           SphereStrides strides);

}  // namespace livery
