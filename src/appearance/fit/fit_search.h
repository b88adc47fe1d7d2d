// One search for a model's parameters: nonlinear least squares by Levenberg and Marquardt (Ceres).
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "appearance/fit/fit_samples.h"
#include "appearance/model_table.h"
#include "core/progress.h"

namespace livery {

/// What residuals are differences of. The logarithm weighs what is bright and what is dark alike;
/// the cube root, as an eye does, brightness a little more.
enum class Metric {
    logarithm,  ///< log(f cos + 0.01)
    cube_root   ///< (f cos)^(1/3)
};

struct FitSearch {
    Metric metric = Metric::logarithm;
    std::size_t stride = 1;           ///< every how manieth sample is looked at
    int steps = 60;                   ///< at most
    std::vector<std::string> held{};  ///< parameters that stay as they start
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
                  const FitSamples& samples,
                  const f64::BsdfParameters& start,
                  const FitSearch& how,
                  const Progress& progress);

/// Root mean square of the residuals.
double rms_of(const ModelInfo& model,
              const FitSamples& samples,
              const f64::BsdfParameters& parameters,
              const FitSearch& how);

}  // namespace livery
