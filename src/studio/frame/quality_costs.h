// What a quality level costs and how far it is from the ground truth, where that was measured; the
// plan panel shows what the frame on the mock-up cost.
#pragma once

#include <utility>

#include "ledger/budget.h"
#include "ledger/machine_speed.h"
#include "scene/frame_plan.h"
#include "studio/studio.h"

namespace livery {

/// What passes took when they last ran: a frame that changes nothing runs none.
struct MeasuredCosts {
    std::chrono::steady_clock::time_point frame_done_at{};  ///< of the newest looked at
    std::map<std::pair<Quality, PassId>, double> pass_ms;
    double total_ms = 0.0, shade_ms = 0.0, compensate_ms = 0.0;  ///< of the last that was drawn
    bool newest_was_drawn = false;
};

struct QualityCost {
    double solve_ms = 0.0;        ///< light, once
    double frame_ms = 0.0;        ///< each paint swap
    std::optional<double> error;  ///< CIEDE2000 at the 95th percentile, by the ledger
};
/// At that quality's levels. Nothing where no cost is known of what the scene calls for.
std::optional<QualityCost> quality_cost(const PriceList& list, Quality quality);

/// Read once, with the ledger's errors: those of the last bench here, else the shipped ones, which
/// the frames of this run scale. Where the user's file is malformed `problem` says so.
const PassCosts& pass_costs(Studio& studio);
/// "by the last bench here", for sentences.
const char* in_words(CostOrigin origin);
/// With them, what is known of the frame on the mock-up.
std::optional<PriceList> price_list(Studio& studio);

/// Once a frame of the window: keeps what the newest frame's passes took. Whether it is new.
bool remember_costs(MeasuredCosts& measured, const FinishedFrame& frame);
/// Scales shipped costs by what the passes of a new frame took.
void scale_costs(Studio& studio, const FramePlan& drawn);
/// Leaves scaled costs for the command line and the next start, unless some were measured
/// meanwhile. A file that cannot be read stays, and what cannot be written is logged.
void keep_scaled_costs(const Studio& studio);
/// Puts the last measured milliseconds in place of those of passes that did not run anew; passes
/// that never ran have none.
void show_last_measured(const MeasuredCosts& measured, FramePlan& plan);

/// What of the last drawn frame's total no pass took: handing pictures on, uploads, the driver.
/// With the passes that run with every paint it adds up to the total.
double time_beside_passes_ms(const MeasuredCosts& measured, const FramePlan& plan);

/// For the operator: what the quality does, what it costs here.
std::string quality_text(Studio& studio, Quality quality);

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
