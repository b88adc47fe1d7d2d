#include "evaluation/statistics/vote_statistics.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "core/error.h"
#include "evaluation/statistics/pairs.h"
#include "evaluation/statistics/preference_tests.h"

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

namespace {

std::string number_word(int number) {
    static constexpr std::array words = {"no",
                                         "one",
                                         "two",
                                         "three",
                                         "four",
                                         "five",
                                         "six",
                                         "seven",
                                         "eight",
                                         "nine",
                                         "ten",
                                         "eleven",
                                         "twelve"};
    return number >= 0 && number < static_cast<int>(words.size())
               ? words[static_cast<std::size_t>(number)]
               : std::to_string(number);
}

/// "about 38 more evaluators, in a fresh round, would tell"
std::string what_would_tell(const std::optional<int>& needed) {
    constexpr int beyond = 1000;
    if (!needed || *needed > beyond) {
        return fmt::format(
            "more than {} more evaluators, in a fresh round, would be needed to tell", beyond);
    }
    // Two figures: it is itself an estimate.
    int unit = 1;
    while (*needed / unit >= 100) unit *= 10;
    const int about = (*needed + unit - 1) / unit * unit;
    return fmt::format("about {} more evaluators, in a fresh round, would tell", about);
}

class VerdictWords {
  public:
    VerdictWords(const VoteStatistics& statistics, const std::vector<std::string>& names)
        : statistics_(statistics), verdict_(statistics.verdict), names_(names) {}

    std::string text() const {
        switch (verdict_.kind) {
            case VerdictKind::nobody:
                return "nobody has voted";
            case VerdictKind::one_evaluator:
                return fmt::format(
                    "one evaluator prefers {} to {}: one ballot tells nothing of others",
                    name(verdict_.leader),
                    name(verdict_.rival));
            case VerdictKind::no_preference:
                return no_preference();
            case VerdictKind::cannot_tell:
                return cannot_tell();
            case VerdictKind::leading:
                return fmt::format(
                    "{} leads, not separated from {}, and may be no better; if it is, {}",
                    name(verdict_.leader),
                    listed(names_of(verdict_.not_apart)),
                    what_would_tell(statistics_.evaluators_needed));
            case VerdictKind::clear_winner:
                return fmt::format("{} is the clear winner", name(verdict_.leader));
        }
        return "";
    }

  private:
    std::string name(int design) const { return names_[static_cast<std::size_t>(design)]; }
    std::vector<std::string> names_of(const std::vector<int>& designs) const {
        std::vector<std::string> names;
        for (const int design : designs) names.push_back(name(design));
        return names;
    }
    std::string these() const {
        return (statistics_.evaluators == 2 ? "the " : "these ") +
               number_word(statistics_.evaluators);
    }

    std::string no_preference() const {
        if (verdict_.too_few) {
            return fmt::format("{} evaluators are too few to show a preference among {} designs",
                               number_word(statistics_.evaluators),
                               number_word(statistics_.counts.designs()));
        }
        const double percent = 100.0 * verdict_.friedman_p;
        return fmt::format(
            "{} show no preference: ballots as far from even come about in {} of rounds without "
            "any",
            these(),
            percent >= 99.5 ? std::string("all")
                            : fmt::format("{:.{}f}%", percent, percent < 10 ? 1 : 0));
    }

    std::string cannot_tell() const {
        std::vector<std::string> others = names_of(verdict_.not_apart);
        const bool tie = statistics_.counts.best[static_cast<std::size_t>(verdict_.leader)] ==
                             statistics_.counts.best[static_cast<std::size_t>(verdict_.rival)] &&
                         statistics_.counts.second[static_cast<std::size_t>(verdict_.leader)] ==
                             statistics_.counts.second[static_cast<std::size_t>(verdict_.rival)];
        return fmt::format("{} cannot tell {} from {}{}{}",
                           these(),
                           name(verdict_.leader),
                           listed(others),
                           tie ? ", which have the same votes" : "",
                           tie ? "" : "; " + what_would_tell(statistics_.evaluators_needed));
    }

    const VoteStatistics& statistics_;
    const Verdict& verdict_;
    const std::vector<std::string>& names_;
};

}  // namespace

std::string listed(const std::vector<std::string>& items) {
    std::string text;
    for (std::size_t k = 0; k < items.size(); ++k) {
        if (k > 0) text += k + 1 == items.size() ? " and " : ", ";
        text += items[k];
    }
    return text;
}

std::string words_of(const VoteStatistics& statistics, const std::vector<std::string>& names) {
    return VerdictWords(statistics, names).text();
}

std::vector<std::string> default_names(int designs) {
    std::vector<std::string> names;
    for (int i = 0; i < designs; ++i)
        names.push_back(std::string("(") + static_cast<char>('a' + i) + ")");
    return names;
}

}  // namespace livery
