#include "evaluation/statistics/vote_statistics.h"

#include <algorithm>
#include <utility>

#include "core/error.h"
#include "evaluation/statistics/agreement.h"
#include "evaluation/statistics/power.h"

namespace livery {

namespace {

std::vector<std::pair<int, int>> pairs_apart(const VoteStatistics& statistics) {
    std::vector<std::pair<int, int>> apart;
    if (!statistics.range_threshold || statistics.friedman_p > 0.05) return apart;
    const auto designs = static_cast<int>(statistics.rank_sums.size());
    const auto sum = [&](int i) { return statistics.rank_sums[static_cast<std::size_t>(i)]; };
    for (int a = 0; a < designs; ++a) {
        for (int b = 0; b < designs; ++b) {
            if (sum(b) - sum(a) >= *statistics.range_threshold) apart.emplace_back(a, b);
        }
    }
    return apart;
}

void add_shares(VoteStatistics& statistics) {
    const VoteCounts& counts = statistics.counts;
    for (std::size_t i = 0; i < counts.best.size(); ++i) {
        statistics.share_best.push_back(wilson_interval(counts.best[i], statistics.evaluators));
        statistics.share_named.push_back(
            wilson_interval(counts.best[i] + counts.second[i], statistics.evaluators));
    }
}

void add_power(VoteStatistics& statistics, const BallotLaw& law) {
    const int leader = statistics.verdict.leader, rival = statistics.verdict.rival;
    if (statistics.evaluators < 2) return;
    for (const int factor : {1, 2, 4}) {
        const int evaluators = factor * statistics.evaluators;
        statistics.power.push_back(
            {evaluators,
             simulated_power(
                 law, evaluators, leader, rival, statistics.seed, statistics.power_rounds)});
    }
    statistics.evaluators_needed = evaluators_for_power(law, leader, rival);
}

}  // namespace

VoteStatistics vote_statistics(const VoteCounts& counts,
                               const std::vector<std::string>& names,
                               std::uint64_t seed,
                               const std::vector<Ballot>* ballots,
                               std::size_t power_rounds) {
    check_counts(counts);
    check_argument(names.size() == counts.best.size(),
                   "names: found " + std::to_string(names.size()) + ", expected " +
                       std::to_string(counts.best.size()) + ", one a design");
    VoteStatistics statistics;
    statistics.counts = counts;
    statistics.evaluators = counts.evaluators();
    statistics.seed = seed;
    statistics.power_rounds = power_rounds;

    // Without a model.
    statistics.best_votes = best_votes_test(counts.best, seed);
    add_shares(statistics);
    statistics.rank_sums = rank_sums(counts);
    statistics.kendall_w = kendall_w(counts);
    statistics.krippendorff_alpha = krippendorff_alpha(ranks_given(counts));
    const RankSumNull null =
        rank_sum_null(counts.designs(), statistics.evaluators, counts.has_least(), seed);
    statistics.friedman_q = friedman_q(counts);
    statistics.friedman_asymptotic_p = chi_square_tail(statistics.friedman_q, counts.designs() - 1);
    statistics.friedman_p = friedman_p(null, counts);
    statistics.friedman_method = null.method;
    statistics.friedman_cases = null.cases;
    statistics.range_threshold = range_threshold(null);
    statistics.apart = pairs_apart(statistics);
    statistics.borda = borda(counts);

    // Under the model of worths.
    const LuceData data = luce_data(counts, ballots);
    const LuceFit fit = fit_luce(data);
    statistics.worths = worths_of(fit);
    statistics.ghost = data.ghost > 0.0;
    statistics.pairs_expected = counts.has_least() && !ballots;
    if (statistics.evaluators > 0) statistics.pairs = compare_pairs(data, fit);
    const BallotLaw law = ballot_law(statistics.worths, counts.has_least());
    const std::vector<int> order = by_worth(fit);
    const int a = std::min(order[0], order[1]), b = std::max(order[0], order[1]);
    statistics.top_a = a;
    statistics.top_b = b;
    statistics.wins = win_probabilities(law, statistics.evaluators, a, b, seed);
    if (ballots && !ballots->empty()) {
        statistics.resampled =
            bootstrap_wins(*ballots, counts.designs(), counts.has_least(), a, b, seed);
    }
    statistics.predicted = predicted_wins(data, statistics.evaluators, seed);
    statistics.verdict = judge(
        counts,
        data,
        fit,
        null,
        [&](int design) { return statistics.predicted.first[static_cast<std::size_t>(design)]; },
        seed);
    add_power(statistics, law);
    statistics.words = words_of(statistics, names);
    return statistics;
}

}  // namespace livery
