#include "evaluation/statistics/rank_sums.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/error.h"

namespace livery {

PlaceScores place_scores(int designs, bool has_least) {
    const int k = designs;
    if (!has_least) return {.best = k + 1, .second = k - 1, .least = 0, .other = 0};
    return {.best = 2 * k - 2, .second = 2 * k - 4, .least = 0, .other = k - 2};
}

std::vector<int> score_sums(const VoteCounts& counts) {
    const PlaceScores scores = place_scores(counts.designs(), counts.has_least());
    const int evaluators = counts.evaluators();
    std::vector<int> sums;
    for (std::size_t i = 0; i < counts.best.size(); ++i) {
        const int least = counts.has_least() ? counts.least[i] : 0;
        const int others = evaluators - counts.best[i] - counts.second[i] - least;
        sums.push_back(scores.best * counts.best[i] + scores.second * counts.second[i] +
                       scores.least * least + scores.other * others);
    }
    return sums;
}

std::vector<double> rank_sums(const VoteCounts& counts) {
    const PlaceScores scores = place_scores(counts.designs(), counts.has_least());
    std::vector<double> sums;
    for (const int score : score_sums(counts)) {
        sums.push_back(counts.evaluators() * (1.0 + 0.5 * scores.best) - 0.5 * score);
    }
    return sums;
}

std::vector<int> borda(const VoteCounts& counts) {
    std::vector<int> points;
    for (std::size_t i = 0; i < counts.best.size(); ++i) {
        points.push_back(2 * counts.best[i] + counts.second[i]);
    }
    return points;
}

std::optional<double> kendall_w(const VoteCounts& counts) {
    const double n = counts.evaluators(), k = counts.designs();
    if (n == 0.0) return std::nullopt;
    double squares = 0.0;
    for (const double sum : rank_sums(counts)) squares += std::pow(sum - 0.5 * n * (k + 1.0), 2);
    // The designs that a ballot leaves unordered are one group of ties.
    const double tied = counts.has_least() ? k - 3.0 : k - 2.0;
    return 12.0 * squares / (n * n * (k * k * k - k - (tied * tied * tied - tied)));
}

double friedman_q(const VoteCounts& counts) {
    return counts.evaluators() * (counts.designs() - 1.0) * kendall_w(counts).value_or(0.0);
}

const char* to_string(Method method) { return method == Method::exact ? "exact" : "drawn"; }

namespace {

double tail(const std::map<std::int64_t, double>& probabilities, std::int64_t from) {
    double sum = 0.0;
    for (auto at = probabilities.lower_bound(from); at != probabilities.end(); ++at) {
        sum += at->second;
    }
    return std::min(sum, 1.0);
}

}  // namespace

double friedman_p(const RankSumNull& null, const VoteCounts& counts) {
    check_argument(null.designs == counts.designs() && null.evaluators == counts.evaluators() &&
                       null.has_least == counts.has_least(),
                   "friedman_p: found counts of " + std::to_string(counts.evaluators()) +
                       " evaluators, expected " + std::to_string(null.evaluators));
    const double p = tail(null.spread, spread_of(score_sums(counts)));
    if (null.method == Method::exact) return p;
    // The round itself is one of the draws: a p of draws is never 0 (Davison and Hinkley 1997).
    const auto draws = static_cast<double>(null.cases);
    return std::min(1.0, (p * draws + 1.0) / (draws + 1.0));
}

std::optional<double> range_threshold(const RankSumNull& null, double level) {
    // Sums of many small probabilities: what is the level but for rounding is the level.
    constexpr double rounding = 1e-12;
    double sum = 0.0;
    std::optional<double> threshold;
    for (auto at = null.range.rbegin(); at != null.range.rend(); ++at) {
        sum += at->second;
        if (sum > level + rounding) break;
        threshold = 0.5 * at->first;
    }
    return threshold;
}

double smallest_p(const RankSumNull& null) {
    return null.spread.empty() ? 1.0 : null.spread.rbegin()->second;
}

}  // namespace livery
