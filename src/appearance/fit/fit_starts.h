// Where searches for a model's parameters start, and those for a thin film on car paint's flakes.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "appearance/fit/fit_brdf.h"
#include "appearance/fit/fit_search.h"
#include "appearance/model_table.h"
#include "core/progress.h"

namespace livery {

/// A fitted paint of another model as one of this: the same where this model holds the other, which
/// the first of them shows; an interface may also be taken for a coat.
std::vector<f64::BsdfParameters> embedded(const ModelInfo& model, const Material& simpler);

/// From several widths of the lobes, and from `simpler` fits of the same samples. Two lobes also
/// start from what one lobe finds and two without a coat, on every `stride`th sample. Throws
/// Cancelled.
std::vector<f64::BsdfParameters> fit_starts(const ModelInfo& model,
                                            const FitSamples& samples,
                                            std::span<const BrdfFit> simpler,
                                            std::size_t stride,
                                            const Progress& progress);

/// The nearest paints with a film, nearest first: many thicknesses and indices on either of the
/// lobes of what fits best without one, each for a few steps on a few samples, then fewer and
/// longer. Colours repeat with each half wavelength of thickness, so no single start finds the
/// film. Throws Cancelled.
std::vector<f64::BsdfParameters> with_films(const ModelInfo& model,
                                            const FitSamples& samples,
                                            const f64::BsdfParameters& without,
                                            const Progress& progress);

}  // namespace livery
