// `livery bench --suite budget`: whether predictions and chosen levels come true on this machine.
// docs/budget.md holds its tables.
#pragma once

#include <string>
#include <vector>

#include "core/progress.h"
#include "gl/context.h"
#include "ledger/level.h"
#include "scene/effects.h"

namespace livery {

/// A random scene at random levels: its first frame, as predicted and as it was.
struct PredictedFrame {
    std::string scene;
    EffectLevels levels;
    double predicted_ms = 0.0, measured_ms = 0.0;
};

/// A scene with few effects at work: what was chosen for a budget, and what drawing every
/// combination of levels that fits it found.
struct ChosenLevels {
    std::string scene;
    double budget_ms = 0.0;
    std::size_t combinations = 0;     ///< that are predicted to fit
    double chosen = 0.0, best = 0.0;  ///< CIEDE2000 at the 95th percentile, measured
    double predicted = 0.0, floor = 0.0;
};

struct BudgetCheck {
    std::string renderer;
    std::vector<PredictedFrame> frames;
    std::vector<ChosenLevels> choices;
};

/// By the costs of the last speed suite here: Refused without one. `quick`: five scenes, one
/// choice.
BudgetCheck check_budget(GlDevice device,
                         bool quick,
                         std::uint64_t seed,
                         const Progress& progress = {});

std::vector<LedgerEffect> effects_of(const BudgetCheck& check);
std::string markdown_of(const BudgetCheck& check);

}  // namespace livery
