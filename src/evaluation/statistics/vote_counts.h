// Ballots as the statistics see them: designs by number, and how often each was named for what.
#pragma once

#include <cstddef>
#include <vector>

namespace livery {

/// The most that a round may have: letters for the designs, and no count that takes minutes.
inline constexpr int kMostDesigns = 26;
inline constexpr int kMostEvaluators = 1000;

/// One evaluator's choices, as numbers of designs; -1: not named.
struct RankedBallot {
    int best = -1, second = -1, least = -1;
};

/// How often each design was named best, second best and, where the ballot asked for it, least.
struct VoteCounts {
    std::vector<int> best, second;
    std::vector<int> least = {};  ///< empty: not asked

    int designs() const { return static_cast<int>(best.size()); }
    int evaluators() const;  ///< the sum of `best`
    bool has_least() const { return !least.empty(); }
};

/// Throws std::invalid_argument (what, found, expected) unless some set of ballots, each of
/// different designs, has these counts. By König's theorem on colouring the edges of a bipartite
/// graph that is so exactly when every list has the same sum and no design is named more often than
/// there are evaluators.
void check_counts(const VoteCounts& counts);

/// Counts of complete ballots. Throws std::invalid_argument for a design named twice in a ballot,
/// not named or not there.
VoteCounts counts_of(const std::vector<RankedBallot>& ballots, int designs, bool has_least);
/// The same of ballots that are known to be sound, of any number.
VoteCounts count_drawn(const std::vector<RankedBallot>& ballots, int designs, bool has_least);

/// How often each pair was named best and second, [best * designs + second]. Counts do not tell;
/// this is the table of largest entropy that has them (iterative proportional fitting, Deming and
/// Stephan 1940).
std::vector<double> expected_pairs(const VoteCounts& counts);

}  // namespace livery
