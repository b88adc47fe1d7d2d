// `livery bench --suite speed`: every stage of the chain timed on this machine.
#pragma once

#include <string>
#include <vector>

#include "core/progress.h"
#include "gl/context.h"
#include "ledger/level.h"
#include "ledger/predictions.h"
#include "ledger/speed_sweep.h"

namespace livery {

struct SpeedBenchResult {
    std::string renderer;
    int threads = 0;
    double load_before = 0.0;       ///< of the last minute, by the system: 0 on a quiet machine
    double covered_fraction = 0.0;  ///< of the 1280x800 picture
    std::vector<BenchEffect> effects;
    std::vector<SweepPoint> sweep;
    std::vector<PassCost> pass_costs;  ///< for predictions; of a whole bench only
};

/// Uses the default bench's projector and the shipped car and looks. Medians over repeats. `quick`:
/// the sweep of the two smaller sizes and frames of normal quality, in half a minute.
SpeedBenchResult run_speed_bench(GlDevice device, bool quick, const Progress& progress = {});

}  // namespace livery
