// The votes for best by themselves, against equal preference.
#pragma once

#include <cstdint>
#include <vector>

#include "evaluation/statistics/rank_sums.h"

namespace livery {

struct BestVotesTest {
    double chi_square = 0.0;
    double asymptotic_p = 1.0;  ///< chi-square with k - 1 degrees of freedom
    double p = 1.0;             ///< of a chi-square as large, over all outcomes of the multinomial
    Method method = Method::exact;
    std::int64_t cases = 0;  ///< outcomes without regard to which design has which count, or draws
};

/// Exact while there are at most `most_states` such outcomes, otherwise from 10^6 draws.
BestVotesTest best_votes_test(const std::vector<int>& best,
                              std::uint64_t seed,
                              std::int64_t most_states = 1'000'000);

}  // namespace livery
