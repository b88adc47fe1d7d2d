// Where searches for a thin film on car paint's flakes start.
#pragma once

#include <cstddef>
#include <vector>

#include "appearance/fit/fit_samples.h"
#include "appearance/model_table.h"
#include "core/progress.h"

namespace livery {

/// The nearest paints with a film, nearest first: many thicknesses and indices on either of the
/// lobes of what fits best without one, each for a few steps on a few samples, then fewer and
/// longer. Colours repeat with each half wavelength of thickness, so no single start finds the
/// film. Throws Cancelled.
std::vector<f64::BsdfParameters> with_films(const ModelInfo& model,
                                            const FitSamples& samples,
                                            const f64::BsdfParameters& without,
                                            const Progress& progress);

}  // namespace livery
