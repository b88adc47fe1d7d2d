// The counts of a round.
#pragma once

#include <string>
#include <vector>

namespace livery {

/// Table 3 of the paper: counts a design.
struct Tally {
    std::vector<std::string> designs;
    std::vector<int> best, second;
    std::vector<int> least = {};  ///< empty where it was not asked for
};

/// "design,best,second" (and "least" where it was asked for) and a line a design, as RFC 4180
/// quotes; UTF-8.
std::string tally_csv(const Tally& tally);

}  // namespace livery
