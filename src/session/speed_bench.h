// `livery bench --suite speed`: every stage of the chain timed on this machine.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/progress.h"
#include "gl/context.h"
#include "session/predictions.h"
#include "session/speed_sweep.h"

namespace livery {

struct BenchLevel {
    std::string name;  ///< "1280x800, normal"
    double ms = 0.0;   ///< median
    double fastest_ms = 0.0;
    int repeats = 0;
    double work_items = 0.0;
    std::optional<double> p95_ms, longest_ms;  ///< where a person waits for each one
    std::optional<double> error;               ///< where the bench has a truth to compare with
    std::string unit;                          ///< of the error
};

struct BenchEffect {
    std::string name;
    std::vector<BenchLevel> levels;
};

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
