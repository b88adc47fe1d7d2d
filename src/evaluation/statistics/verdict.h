// What a round says in words, and never more than its ballots do.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "evaluation/statistics/plackett_luce.h"
#include "evaluation/statistics/preference_tests.h"

namespace livery {

enum class VerdictKind {
    nobody,         ///< no ballots
    one_evaluator,  ///< a single ballot tells nothing of others
    no_preference,  ///< Friedman's exact p is above .05: nothing more is said
    cannot_tell,    ///< a preference, but not for which: the first two tie or might as well be
                    ///< swapped
    leading,        ///< first in two rounds of three at least, but not apart from all others
    clear_winner
};
const char* to_string(VerdictKind kind);  ///< "clear winner", ...

struct Verdict {
    VerdictKind kind = VerdictKind::nobody;
    int leader = -1;  ///< of the largest worth
    int rival = -1;   ///< whom the leader is least apart from, by likelihood ratio
    double friedman_p = 1.0;
    double win_probability = 0.0;  ///< of the leader, by rank sums, in a round of other evaluators
    /// Of leader against rival under its own law; 1 where chi-square does not pass either.
    double rival_p = 1.0;
    std::vector<int> not_apart = {};  ///< from the leader
    bool too_few = false;             ///< no ballots of so few evaluators could show a preference
};

/// Whether the round tells that design from the leader: what charts mark is what the verdict says.
bool told_from_leader(const Verdict& verdict, int design);

/// The designs, that of the largest worth first; equal ones in their order.
std::vector<int> by_worth(const LuceFit& fit);

/// A clear winner needs all of: Friedman's exact p at most .05; the 95% profile-likelihood interval
/// of the leader against each other without 1; first in .85 of rounds of other evaluators; the
/// rival's calibrated p (calibrated_pair_p()) at most .04. `null` is that of the counts' size;
/// `win_probability` is that of a design, asked for where Friedman's p passes.
Verdict judge(const VoteCounts& counts,
              const LuceData& data,
              const LuceFit& fit,
              const RankSumNull& null,
              const std::function<double(int design)>& win_probability,
              std::uint64_t seed);

}  // namespace livery
