// `livery bench --suite accuracy`: what each reflectance model is worth at the inputs where models
// break. docs/accuracy.md holds its tables.
#pragma once

#include <string>
#include <vector>

#include "appearance/hard_cases.h"
#include "core/progress.h"
#include "gl/context.h"
#include "ledger/level.h"

namespace livery {

struct ModelAccuracy {
    ReflectanceModel model = ReflectanceModel::lambert;
    std::vector<PrecisionError> in_float;  ///< a row for each slope parameter
    std::vector<double> on_gpu;  ///< worst relative error of OpenGL's values against double, alike
    double reciprocity = 0.0;    ///< worst relative difference with light and eye exchanged, float
    WorstAlbedo albedo;
    InvalidValues invalid;
    double ms = 0.0;  ///< that measuring it took
};

struct AccuracyLedger {
    std::string renderer;
    std::vector<ModelAccuracy> models;
};

/// `quick`: a hundredth of the inputs, in seconds instead of minutes. The answer depends on the
/// seed, not on the machine, but for OpenGL's part.
AccuracyLedger measure_accuracy(GlDevice device,
                                bool quick,
                                std::uint64_t seed,
                                const Progress& progress = {});

/// An effect for each model, its figures as errors.
std::vector<LedgerEffect> effects_of(const AccuracyLedger& result);
std::string text_of(const AccuracyLedger& result);
/// A table of the models, and one of the errors at each slope parameter.
std::string markdown_of(const AccuracyLedger& result);

}  // namespace livery
