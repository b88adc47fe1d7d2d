// The speed ledger's sweep as a picture.
#pragma once

#include <string>
#include <vector>

#include "ledger/speed_sweep.h"

namespace livery {

/// SVG: milliseconds against the mock-up's pixels, both logarithmic, each stage on all threads and
/// the whole swap on one too, with the power law that fits it best. Throws std::invalid_argument
/// for a sweep without points.
std::string sweep_svg(const std::vector<SweepPoint>& sweep);

}  // namespace livery
