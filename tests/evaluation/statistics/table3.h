// Table 3 of Park, Lim, Seo, Jung and Lee (2015): ten evaluators, four designs.
#pragma once

#include "evaluation/ballot.h"

namespace livery {

inline VoteCounts table3() { return {{1, 6, 1, 2}, {0, 3, 2, 5}}; }

}  // namespace livery
