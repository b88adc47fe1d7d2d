// Tests without a model, of whether there is any preference: Friedman's and Kendall's W on the
// ranks of partly ordered ballots, Krippendorff's alpha, the range of rank sums, Borda, and the
// votes for best by themselves.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "evaluation/ballot.h"

namespace livery {

/// What a ballot gives a design for a place, in half ranks above the worst that it gives anybody:
/// twice the difference of mid-ranks. A higher sum is a lower, better rank sum.
struct PlaceScores {
    int best = 0, second = 0, least = 0, other = 0;
};
PlaceScores place_scores(int designs, bool has_least);
std::vector<int> score_sums(const VoteCounts& counts);

/// sum (score - mean)^2, times k^2 so that it is a whole number.
template <typename Scores>
std::int64_t spread_of(const Scores& scores) {
    std::int64_t sum = 0, spread = 0;
    for (const auto score : scores) sum += score;
    for (const auto score : scores) {
        const std::int64_t off = static_cast<std::int64_t>(scores.size()) * score - sum;
        spread += off * off;
    }
    return spread;
}

/// Sums over the evaluators of the ranks: 1, 2, and for the designs that a ballot leaves unordered
/// the mean of their places, (k + 3)/2; with the least at k, (k + 2)/2.
std::vector<double> rank_sums(const VoteCounts& counts);

/// 2 for best, 1 for second best (Borda), 0 for the others.
std::vector<int> borda(const VoteCounts& counts);

/// Kendall and Babington Smith's coefficient of concordance, corrected for ties; nothing without
/// ballots.
std::optional<double> kendall_w(const VoteCounts& counts);
/// Friedman's chi-square, N (k - 1) W; 0 without ballots.
double friedman_q(const VoteCounts& counts);

/// Whether every case was counted, or cases were drawn.
enum class Method { exact, drawn };
const char* to_string(Method method);  ///< "exact", "drawn"

/// How rank sums fall when every possible ballot is equally likely, each evaluator by himself.
struct RankSumNull {
    int designs = 0, evaluators = 0;
    bool has_least = false;
    Method method = Method::exact;
    std::int64_t cases = 0;                 ///< states of the last step, or draws
    std::map<std::int64_t, double> spread;  ///< probability of each spread_of() the scores
    std::map<int, double> range;            ///< probability of each largest - smallest score
};

/// By convolving the k (k - 1) possible ballots (times k - 2 with a least), rank sums counted
/// without regard to whose they are, while that takes at most `most_steps`: one is a state and a
/// ballot. Otherwise from 10^6 draws, the same for a seed.
RankSumNull rank_sum_null(int designs,
                          int evaluators,
                          bool has_least,
                          std::uint64_t seed,
                          std::int64_t most_steps = 2'000'000);

/// P(Q >= the counts' Q) under `null`, which must be that of their size.
double friedman_p(const RankSumNull& null, const VoteCounts& counts);

/// The smallest difference of two rank sums that any pair of designs reaches with probability
/// `level` at most; nothing where even the largest difference is more likely.
std::optional<double> range_threshold(const RankSumNull& null, double level = 0.05);
/// The smallest p that a round of this size can have.
double smallest_p(const RankSumNull& null);

/// Krippendorff's alpha for values on an interval scale. `values[u]` are those that the coders gave
/// unit u, in any order; who gave none is left out. A unit with fewer than two says nothing.
/// Nothing where no unit has two, or all values are the same. Krippendorff, Content Analysis, 2004.
std::optional<double> krippendorff_alpha(const std::vector<std::vector<double>>& values);

/// The mid-ranks that ballots give each design, [design][...]: with no second best named the others
/// share their places, a ballot without a best gives none. Ranks of complete ballots make alpha the
/// same on an interval as on an ordinal scale.
std::vector<std::vector<double>> ranks_given(const std::vector<Ballot>& ballots, int designs);
/// The same from the counts of complete ballots.
std::vector<std::vector<double>> ranks_given(const VoteCounts& counts);

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
