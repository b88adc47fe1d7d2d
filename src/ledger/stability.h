// `livery bench --suite stability`: what is drawn, and each reflectance model by itself, at the
// inputs where they break. docs/stability.md holds its tables.
#pragma once

#include <string>
#include <vector>

#include "appearance/hard_cases.h"
#include "core/progress.h"
#include "gl/context.h"
#include "ledger/drawn_errors.h"
#include "ledger/level.h"

namespace livery {

struct ModelStability {
    ReflectanceModel model = ReflectanceModel::lambert;
    std::vector<PrecisionError> in_float;  ///< a row for each slope parameter
    std::vector<double> on_gpu;  ///< worst relative error of OpenGL's values against double, alike
    double reciprocity = 0.0;    ///< worst relative difference with light and eye exchanged, float
    WorstAlbedo albedo;
    InvalidValues invalid;
    double ms = 0.0;  ///< that measuring it took
};

struct StabilityLedger {
    std::string renderer;
    std::vector<DrawnError> drawn;
    std::vector<ModelStability> models;
};

/// `quick`: a hundredth of the inputs, in seconds instead of minutes. The answer depends on the
/// seed, not on the machine, but for OpenGL's part.
StabilityLedger measure_stability(GlDevice device,
                                  bool quick,
                                  std::uint64_t seed,
                                  const Progress& progress = {});

/// An effect for each paint in each light and for each model, its figures as errors.
std::vector<LedgerEffect> effects_of(const StabilityLedger& result);
/// Tables of what is drawn, of the models, and of their errors at each slope parameter.
std::string markdown_of(const StabilityLedger& result);

}  // namespace livery
