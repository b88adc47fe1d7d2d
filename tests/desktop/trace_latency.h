// How long inputs took to reach the projector, from the program's trace.
#pragma once

#include <optional>
#include <vector>

#include "desktop/studio_program.h"

namespace livery {

/// Seconds on the clock that the trace is written with.
double trace_now_s();

/// From each moment in `inputs_s` to the first picture on the projector that was asked for after
/// it, milliseconds; nothing where no picture came before the next input.
std::vector<std::optional<double>> to_projector_ms(const std::vector<TraceLine>& trace,
                                                   const std::vector<double>& inputs_s);

/// Nearest rank; throws std::invalid_argument without values.
double percentile_of(std::vector<double> values, double fraction);

}  // namespace livery
