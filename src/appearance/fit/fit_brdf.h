// Measured reflectance -> parameters of the reflectance models, by nonlinear least squares (Ceres).
//
// Residuals are log(f cos + 0.01), all channels together: highlights a thousand times brighter than
// the rest do not decide alone, and what nobody sees weighs little. Every search starts from
// several widths of the lobe and from what simpler models of the same data found, that of car paint
// also from many films on its flakes. The last stage goes by what is seen on a lit sphere, from
// the nearest of all ends and of the simpler models embedded in this one: a larger model ends no
// worse than one that it holds.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "appearance/fit/fit_search.h"
#include "appearance/material.h"
#include "appearance/measured/measured_grid.h"
#include "core/progress.h"

namespace livery {

struct BrdfFit {
    Material material;       ///< unnamed; parameters rounded to six digits
    double error_log = 0.0;  ///< root mean square of the logarithms' residuals
    ReflectanceDifference difference;
    double largest_albedo = 0.0;  ///< over angles up to 80 degrees, of its largest channel
    double seconds = 0.0;         ///< of one thread
};

/// What fits are ranked by: the mean CIEDE2000, a fifth of its 95th percentile, so that a small
/// part of a paint that looks like another one counts as it is seen, and the logarithms' error,
/// which decides between what looks alike.
double weighed_error(const BrdfFit& fit);
inline constexpr const char* kWeighedError = "mean + 95% / 5 + log error";

/// The best of one model; its start may use `simpler` fits of the same samples. Throws
/// std::invalid_argument (no samples, a value that is not finite), Cancelled.
BrdfFit fit_model(ReflectanceModel model,
                  const FitSamples& samples,
                  const ReflectanceFunction& truth_working,
                  std::span<const BrdfFit> simpler = {},
                  const Progress& progress = {});

/// Every model that has parameters to fit, the smallest weighed error first.
std::vector<BrdfFit> fit_all_models(const FitSamples& samples,
                                    const ReflectanceFunction& truth_working,
                                    const Progress& progress = {});

}  // namespace livery
