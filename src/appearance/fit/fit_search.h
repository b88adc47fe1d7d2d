// One search for a model's parameters: nonlinear least squares by Levenberg and Marquardt (Ceres).
#pragma once

#include <string>
#include <vector>

#include "appearance/fit/fit_residuals.h"
#include "appearance/model_table.h"
#include "core/progress.h"

namespace livery {

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
