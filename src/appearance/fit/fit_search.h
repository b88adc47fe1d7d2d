// One search for a model's parameters by nonlinear least squares (Levenberg and Marquardt, Ceres):
// the samples that it is fitted to, and the residuals that are made small.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "appearance/directions.h"
#include "appearance/measured/measured_grid.h"
#include "appearance/model_table.h"
#include "appearance/paint_bsdf.h"
#include "core/progress.h"

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

struct FitSearch {
    int steps = 60;                    ///< at most
    std::vector<std::string> held{};   ///< parameters that stay as they start
    std::vector<std::string> freed{};  ///< and those that stay otherwise: a film, a coat's tint
};

struct Found {
    f64::BsdfParameters parameters{};
    double rms = 0.0;  ///< of the residuals
};

/// Whether the model has parameters that a search can turn: all but tables.
bool can_be_fitted(const ModelInfo& model);

/// From these parameters downhill; both numbers of a pair stay equal, for samples of half and
/// difference angles say nothing of a grain. Throws Cancelled.
Found search_from(const ModelInfo& model,
                  const Residuals& residuals,
                  const f64::BsdfParameters& start,
                  const FitSearch& how,
                  const Progress& progress);

/// Root mean square of the residuals.
double rms_of(const ModelInfo& model,
              const Residuals& residuals,
              const f64::BsdfParameters& parameters);

}  // namespace livery
