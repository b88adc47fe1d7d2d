// A ballot, and how often the looks of a round were named.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace livery {

/// The most that a round may have: letters for the designs, and no count that takes minutes.
inline constexpr int kMostDesigns = 26;
inline constexpr int kMostEvaluators = 1000;

/// One evaluator's choices, as indices of the round's designs, all different; -1: not named.
struct Ballot {
    int best = -1, second = -1, least = -1;
    bool operator==(const Ballot&) const = default;
};

/// How often each design was named best, second best and, where the ballot asked for it, least.
struct VoteCounts {
    std::vector<int> best, second;
    std::vector<int> least = {};  ///< empty: not asked

    int designs() const { return static_cast<int>(best.size()); }
    int evaluators() const;  ///< the sum of `best`
    bool has_least() const { return !least.empty(); }
};

/// Of ballots that are known to be sound, of any number; not all need to name a least.
VoteCounts count_ballots(const std::vector<Ballot>& ballots, int designs, bool has_least);
/// The same of complete ballots. Throws std::invalid_argument for a design named twice in a ballot,
/// not named or not there, and as check_counts().
VoteCounts counts_of(const std::vector<Ballot>& ballots, int designs, bool has_least);

/// Throws std::invalid_argument (what, found, expected) unless some set of ballots, each of
/// different designs, has these counts. By König's theorem on colouring the edges of a bipartite
/// graph that is so exactly when every list has the same sum and no design is named more often than
/// there are evaluators.
void check_counts(const VoteCounts& counts);

/// How often each pair was named best and second, [best * designs + second]. Counts do not tell;
/// this is the table of largest entropy that has them (iterative proportional fitting, Deming and
/// Stephan 1940).
std::vector<double> expected_pairs(const VoteCounts& counts);

/// Table 3 of the paper: "design,best,second" (and "least" where it was asked for) and a line a
/// design, as RFC 4180 quotes; UTF-8.
std::string tally_csv(const std::vector<std::string>& designs, const VoteCounts& counts);

/// A text as a cell, quoted where RFC 4180 asks for it. Before one that spreadsheets would take for
/// a formula stands an apostrophe. Not for numbers.
std::string csv_field(const std::string& text);

}  // namespace livery
