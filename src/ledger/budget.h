// Levels for a budget: of all combinations that fit the time, the one that leaves the least visible
// error.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "ledger/predictions.h"

namespace livery {

/// Milliseconds; none: any.
struct Budget {
    std::optional<double> first_frame_ms;  ///< all passes
    std::optional<double> swap_ms;         ///< those that run with every paint
};

/// What one level would take and leave, all other effects as chosen.
struct LevelPrice {
    int level = 0;
    PredictedTime time;
    double error = 0.0;  ///< of the whole frame, CIEDE2000 at the 95th percentile
};

/// An effect of a scene at the levels that were chosen, or asked for.
struct EffectPrice {
    Effect effect = Effect::sub_samples;
    bool called_for = false;
    LevelPrice chosen;
    double own_ms = 0.0;  ///< of its passes
    double added = 0.0;   ///< what the level leaves by itself, CIEDE2000
    /// Interreflection that is left out: the most that it can be, by the parts' albedos.
    std::optional<double> bound;
    std::optional<LevelPrice> next;  ///< the next dearer level; none: this is the last
    std::optional<LevelPrice> off;   ///< the first level, where the chosen one is not
};

struct PricedFrame {
    EffectLevels levels;
    PredictedTime time;
    double error = 0.0;  ///< CIEDE2000 at the 95th percentile
    std::vector<EffectPrice> effects;
    std::string note;  ///< what could not be predicted
};

/// What the machine and the ledger say of a scene: areas as covered_areas() has them.
struct PriceList {
    const Scene& scene;
    FrameStage stage;
    FrameCounts areas;
    std::vector<PassCost> costs;
    EffectErrors errors;
    std::array<bool, kEffects> called_for{};
};
/// Of the errors it keeps those of scenes that have an environment as this one.
PriceList make_price_list(const Scene& scene,
                          FrameStage stage,
                          FrameCounts areas,
                          std::vector<PassCost> costs,
                          EffectErrors errors);

/// Fills the plan's work items, predicted_ms and predicted_error; returns a note for people, empty
/// when everything is predicted.
std::string predict(FramePlan& plan, const PriceList& list);

/// What a frame at these levels takes and leaves.
PredictedTime time_of(const PriceList& list, const EffectLevels& levels);
double error_of(const PriceList& list, const EffectLevels& levels);

/// The price of a frame at these levels, effect by effect.
PricedFrame priced(const PriceList& list, const EffectLevels& levels);

/// The levels with the least error among those that fit; among those within a hundredth of it, the
/// cheapest. Glints are always drawn: the ledger has no truth for them. Throws Refused when none
/// fit, with what the cheapest would take.
EffectLevels levels_within(const PriceList& list, const Budget& budget);

/// All that levels_within() chooses from.
std::vector<EffectLevels> combinations(const PriceList& list);

/// A line an effect: level, milliseconds, what it leaves, what the next level would buy.
std::string text_of(const PricedFrame& frame);

}  // namespace livery
