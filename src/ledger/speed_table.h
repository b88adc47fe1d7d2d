// The speed bench in words: for the terminal, and as Markdown for docs/performance.md.
#pragma once

#include <string>

#include "ledger/speed.h"

namespace livery {

std::string text_of(const SpeedBenchResult& result);

/// Tables of the sweep, the stages and the desktop.
std::string markdown_of(const SpeedBenchResult& result);

}  // namespace livery
