// What the plan panel remembers between frames.
#pragma once

#include <array>
#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "ledger/machine_speed.h"
#include "studio/frame/quality_costs.h"

namespace livery {

struct PlanPanelState {
    MeasuredCosts measured;
    std::optional<PassCosts> costs;    ///< as known; none: not read yet
    std::optional<PassCosts> shipped;  ///< where nobody measured: what frames scale
    PassRatios ratios;                 ///< of the frames of this run
    EffectErrors errors;
    std::string problem;
    /// Of draft, normal and high, for the frame that was done then.
    std::array<std::optional<QualityCost>, 3> of_qualities;
    std::chrono::steady_clock::time_point priced_at{};
    /// The levels in the document, for the frame that was done then.
    std::optional<PricedFrame> frame_price;
    std::chrono::steady_clock::time_point frame_priced_at{};
};

}  // namespace livery
