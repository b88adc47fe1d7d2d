// Who would win another round.
#pragma once

#include <cstdint>
#include <vector>

#include "evaluation/statistics/ballot_law.h"
#include "evaluation/statistics/plackett_luce.h"
#include "evaluation/statistics/preference_tests.h"

namespace livery {

/// Of rounds of as many evaluators, by rank sums.
struct WinProbabilities {
    std::vector<double> first;  ///< that each design is first; where several are, they share it
    /// That two given designs are the top two. Where n designs reach the second place's sum, each
    /// of their n (n - 1)/2 pairs has a share: with a tie for second place alone that is less than
    /// an even split among those that tie, so this errs to the low side.
    double top_two = 0.0;
    Method method = Method::exact;
    std::int64_t cases = 0;  ///< states of rank sums that there is room for, or draws
};

/// Under a law of ballots: by convolution over the sums while there are at most `most_states`, and
/// 3 * 10^9 additions; otherwise from 10^5 draws. No evaluators: all designs tie.
WinProbabilities win_probabilities(const BallotLaw& law,
                                   int evaluators,
                                   int top_a,
                                   int top_b,
                                   std::uint64_t seed,
                                   std::int64_t most_states = 1'000'000);

/// Of a round of as many other evaluators, with what these ballots leave open: the worths are not
/// known but fitted. From 2000 rounds drawn under the worths fitted with a ghost of weight 1, to
/// each of which worths are fitted anew, 20 rounds drawn under those: the error of the estimate
/// counts twice, once as it was made and once as it may be made again. No evaluators: all tie.
WinProbabilities predicted_wins(const LuceData& data, int evaluators, std::uint64_t seed);

/// Of 10^4 rounds drawn from the ballots, with replacement (Efron 1979).
WinProbabilities bootstrap_wins(const std::vector<Ballot>& ballots,
                                int designs,
                                bool has_least,
                                int top_a,
                                int top_b,
                                std::uint64_t seed);

}  // namespace livery
