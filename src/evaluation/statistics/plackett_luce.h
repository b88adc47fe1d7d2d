// Worths behind a round's ballots: the model of Luce (1959) and Plackett (1975).
#pragma once

#include <optional>
#include <vector>

#include "evaluation/ballot.h"
#include "evaluation/statistics/ballot_law.h"

namespace livery {

/// What the likelihood goes by. For best and second best that is the counts alone,
///   sum (b_i + s_i) ln w_i - N ln sum w - sum b_i ln(sum w - w_i),
/// the factor of a least, (1 / w_l) / sum 1 / w over those left, needs the pairs too.
struct LuceData {
    std::vector<double> best, second, least;
    std::vector<double> pairs;  ///< [best * designs + second]; empty without a least
    /// So many wins and as many losses of each design against one of worth 1 that nobody sees: half
    /// of each in the R package PlackettLuce (Turner, van Etten, Firth and Kosmidis 2020); 0: none.
    double ghost = 0.0;
};
inline constexpr double kGhost = 0.5;

/// With the pairs that the counts make likely (expected_pairs()) or, where they are known, with
/// those of the ballots. With the ghost where it is needed.
LuceData luce_data(const VoteCounts& counts, const std::vector<Ballot>* ballots = nullptr);
LuceData luce_data(const ExpectedVotes& votes);

/// Without it the likelihood has no maximum: a design has no vote, or one has all for best, so that
/// who won over whom is not strongly connected.
bool needs_ghost(const VoteCounts& counts);

/// A difference of two log-worths that is held.
struct HeldOdds {
    int a = 0, b = 0;
    double log_odds = 0.0;  ///< ln w_a / w_b
};

struct LuceFit {
    std::vector<double> log_worths;  ///< their mean is 0 without the ghost
    double log_likelihood = 0.0;
};
/// The largest likelihood, by Newton's method on the log-worths, in which it is concave, with steps
/// halved until they climb. It has converged when no derivative is larger than 1e-9 ballots.
/// `start` may be empty.
LuceFit fit_luce(const LuceData& data,
                 const std::optional<HeldOdds>& held = std::nullopt,
                 const std::vector<double>& start = {});

/// They add up to 1.
std::vector<double> worths_of(const LuceFit& fit);
/// Of the difference of two log-worths, from the inverse of the information.
double standard_error(const LuceData& data, const LuceFit& fit, int a, int b);
/// 2 (largest log-likelihood - that with the odds held); never negative.
double deviance(const LuceData& data, const LuceFit& fit, const HeldOdds& held);

}  // namespace livery
