// The speed ledger in words: for the terminal, and as Markdown for docs/performance.md.
#pragma once

#include <string>

#include "ledger/speed.h"

namespace livery {

std::string text_of(const SpeedLedger& result);

/// Tables of the sweep, the stages and the desktop.
std::string markdown_of(const SpeedLedger& result);

}  // namespace livery
