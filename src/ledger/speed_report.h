// The speed ledger in words, as Markdown and as a picture.
#pragma once

#include <string>
#include <vector>

#include "ledger/speed.h"
#include "ledger/speed_sweep.h"

namespace livery {

/// Tables of the sweep, the stages and the desktop.
std::string markdown_of(const SpeedLedger& result);

/// SVG: milliseconds against the mock-up's pixels, both logarithmic, each stage on all threads and
/// the whole swap on one too, with the power law that fits it best. Throws std::invalid_argument
/// for a sweep without points.
std::string sweep_svg(const std::vector<SweepPoint>& sweep);

}  // namespace livery
