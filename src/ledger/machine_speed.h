// How fast this machine is beside the one that timed the shipped costs, from frames that it draws
// anyway.
#pragma once

#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "ledger/pass_costs.h"

namespace livery {

/// Passes that find everything done before still take some microseconds.
inline constexpr double kNothingToDo_ms = 0.05;

/// What passes of drawn frames took, over what the shipped costs say of them.
struct PassRatios {
    struct OfPass {
        double shipped_ms = 0.0;     ///< of the last
        std::vector<double> ratios;  ///< the last few
    };
    std::map<std::pair<PassId, int>, OfPass> passes;  ///< by cost_key() and level
};

/// Adds those passes that ran and know their work items.
void add_ratios(PassRatios& known, const FramePlan& drawn, const std::vector<PassCost>& shipped);

/// The shipped costs times how much longer passes took here: of those that run with every paint by
/// one factor, of those that are solved once by another, since a graphics card may do the former.
/// Nothing before enough has run to tell.
std::optional<PassCosts> scaled_costs(PassCosts shipped, const PassRatios& ratios);

}  // namespace livery
