// Measured reflectance -> parameters of the reflectance models, by nonlinear least squares (Ceres).
//
// Residuals are log(f cos + 0.01), all channels together: highlights a thousand times brighter than
// the rest do not decide alone, and what nobody sees weighs little. Every search starts from
// several widths of the lobe and from what simpler models of the same data found.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "appearance/directions.h"
#include "appearance/material.h"
#include "appearance/measured_grid.h"
#include "appearance/model_table.h"
#include "core/progress.h"

namespace livery {

/// Whether the model has parameters that a search can turn: all but tables.
bool can_be_fitted(const ModelInfo& model);

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

struct BrdfFit {
    Material material;       ///< unnamed; parameters rounded to six digits
    double error_log = 0.0;  ///< root mean square of the residuals
    ReflectanceDifference difference;
    double largest_albedo = 0.0;  ///< over angles up to 80 degrees, of its largest channel
    double seconds = 0.0;         ///< of one thread
};

/// The best of one model; its start may use `simpler` fits of the same samples. Throws
/// std::invalid_argument (no samples, a value that is not finite), Cancelled.
BrdfFit fit_model(ReflectanceModel model,
                  const FitSamples& samples,
                  const ReflectanceFunction& truth_working,
                  std::span<const BrdfFit> simpler = {},
                  const Progress& progress = {});

/// Every model that has parameters to fit, the smallest CIEDE2000 first.
std::vector<BrdfFit> fit_all_models(const FitSamples& samples,
                                    const ReflectanceFunction& truth_working,
                                    const Progress& progress = {});

}  // namespace livery
