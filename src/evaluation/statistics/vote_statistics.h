// Everything that is said about a round of votes.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "evaluation/statistics/figures.h"
#include "evaluation/statistics/pairs.h"
#include "evaluation/statistics/preference_tests.h"
#include "evaluation/statistics/verdict.h"
#include "evaluation/statistics/winners.h"

namespace livery {

struct VoteStatistics {
    VoteCounts counts;
    int evaluators = 0;
    std::uint64_t seed = 1;

    BestVotesTest best_votes;
    std::vector<Interval> share_best, share_named;  ///< of best; of best or second: 95% (Wilson)

    std::vector<double> rank_sums;
    std::optional<double> kendall_w, krippendorff_alpha;
    double friedman_q = 0.0, friedman_asymptotic_p = 1.0, friedman_p = 1.0;
    Method friedman_method = Method::exact;
    std::int64_t friedman_cases = 0;
    std::optional<double> range_threshold;   ///< of rank sums, 5% over all pairs
    std::vector<std::pair<int, int>> apart;  ///< by it; the better one first
    std::vector<int> borda;

    std::vector<double> worths;  ///< Plackett and Luce's; they add up to 1
    bool ghost = false;          ///< fitted with the ghost item
    /// The counts leave open which best went with which second; a least's factor needs it.
    bool pairs_expected = false;
    std::vector<PairComparison> pairs;  ///< none without ballots

    WinProbabilities wins;  ///< under the fitted worths
    int top_a = 0, top_b = 1;
    WinProbabilities predicted;                 ///< of a round of other evaluators; `first` alone
    std::optional<WinProbabilities> resampled;  ///< from the ballots, where they are known

    struct Power {
        int evaluators = 0;
        double power = 0.0;
    };
    /// Of leader against rival, for fresh rounds; none with less than two evaluators.
    std::vector<Power> power;
    std::size_t power_rounds = 0;          ///< drawn for each
    std::optional<int> evaluators_needed;  ///< for .80

    Verdict verdict;
    std::string words;  ///< the verdict, in one or two sentences
};

/// `ballots`: what the counts count, where they are known; `power_rounds`: drawn for each power.
/// `names` are what `words` calls the designs. Throws std::invalid_argument as check_counts(), and
/// for another number of names.
VoteStatistics vote_statistics(const VoteCounts& counts,
                               const std::vector<std::string>& names,
                               std::uint64_t seed,
                               const std::vector<Ballot>* ballots = nullptr,
                               std::size_t power_rounds = 4000);

/// "(a)", "(b)", ... as the paper calls them.
std::vector<std::string> default_names(int designs);

/// "(b)", "(b) and (c)", "(b), (c) and (d)"
std::string listed(const std::vector<std::string>& items);

/// The verdict of `statistics`, whose `words` are not yet made.
std::string words_of(const VoteStatistics& statistics, const std::vector<std::string>& names);

}  // namespace livery
