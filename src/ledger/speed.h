// `livery bench --suite speed` and `--suite costs`: every stage of the chain timed on this machine.
#pragma once

#include <string>
#include <vector>

#include "core/progress.h"
#include "gl/context.h"
#include "ledger/level.h"
#include "ledger/pass_costs.h"
#include "ledger/speed_sweep.h"

namespace livery {

struct SpeedLedger {
    std::string renderer;
    int threads = 0;
    double load_before = 0.0;       ///< of the last minute, by the system: 0 on a quiet machine
    double covered_fraction = 0.0;  ///< of the 1280x800 picture
    std::vector<LedgerEffect> effects;
    std::vector<SweepPoint> sweep;
    std::vector<PassCost> pass_costs;  ///< for predictions; empty where `quick`
};

/// Uses the default bench's projector and the shipped car and looks. Medians over repeats. `quick`:
/// the sweep of the two smaller sizes and frames of normal quality, in half a minute.
SpeedLedger measure_speed(GlDevice device, bool quick, const Progress& progress = {});

/// What predictions need of it.
PassCosts costs_of(const SpeedLedger& ledger);
/// The same in half the time: only frames are timed.
PassCosts measure_costs(GlDevice device, const Progress& progress = {});

/// The shipped costs scaled by one small frame and some paint swaps, in seconds.
PassCosts measure_machine(GlDevice device, const Progress& progress = {});

}  // namespace livery
