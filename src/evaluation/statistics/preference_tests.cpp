#include "evaluation/statistics/preference_tests.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <string>
#include <unordered_map>

#include "core/error.h"
#include "evaluation/statistics/ballot_law.h"
#include "evaluation/statistics/figures.h"

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

namespace {

/// Scores in falling order. A string for its hash, and because up to seven stay without memory of
/// their own.
using State = std::u16string;
using States = std::unordered_map<State, double>;

/// Adds to `next` every way in which one more ballot can give its places to the designs of `state`.
/// Designs with the same score are one case.
class OneMoreBallot {
  public:
    OneMoreBallot(const PlaceScores& scores, bool has_least, States& next)
        : next_(next), other_(static_cast<char16_t>(scores.other)) {
        gains_ = {scores.best - scores.other, scores.second - scores.other};
        if (has_least) gains_.push_back(scores.least - scores.other);
    }
    void operator()(const State& state, double probability) {
        before_ = state;
        after_ = state;
        for (char16_t& score : after_) score = static_cast<char16_t>(score + other_);
        taken_.assign(state.size(), false);
        give(0, probability);
    }

    std::int64_t steps() const { return steps_; }

  private:
    void give(std::size_t place, double probability) {
        if (place == gains_.size()) {
            sorted_ = after_;
            // By insertion: it was in order but for two or three.
            for (std::size_t i = 1; i < sorted_.size(); ++i) {
                for (std::size_t j = i; j > 0 && sorted_[j] > sorted_[j - 1]; --j) {
                    std::swap(sorted_[j], sorted_[j - 1]);
                }
            }
            next_[sorted_] += probability;
            ++steps_;
            return;
        }
        const double left = static_cast<double>(before_.size() - place);
        for (std::size_t i = 0; i < before_.size();) {
            // The first free one of those with this score stands for all of them.
            std::size_t chosen = before_.size();
            int alike = 0;
            const char16_t score = before_[i];
            for (; i < before_.size() && before_[i] == score; ++i) {
                if (taken_[i]) continue;
                if (alike++ == 0) chosen = i;
            }
            if (alike == 0) continue;
            taken_[chosen] = true;
            after_[chosen] = static_cast<char16_t>(after_[chosen] + gains_[place]);
            give(place + 1, probability * alike / left);
            after_[chosen] = static_cast<char16_t>(after_[chosen] - gains_[place]);
            taken_[chosen] = false;
        }
    }

    States& next_;
    std::int64_t steps_ = 0;
    std::vector<int> gains_;
    char16_t other_;
    State before_, after_, sorted_;
    std::vector<bool> taken_;
};

/// False when it takes more steps than that.
bool convolve(RankSumNull& null, std::int64_t most_steps) {
    const PlaceScores scores = place_scores(null.designs, null.has_least);
    States states{{State(static_cast<std::size_t>(null.designs), u'\0'), 1.0}};
    std::int64_t steps = 0;
    for (int n = 0; n < null.evaluators; ++n) {
        States next;
        next.reserve(2 * states.size());
        OneMoreBallot add(scores, null.has_least, next);
        for (const auto& [state, probability] : states) {
            add(state, probability);
            if (steps + add.steps() > most_steps) return false;
        }
        steps += add.steps();
        states = std::move(next);
    }
    // In one order everywhere: what is added up in another differs in its last digit.
    std::vector<std::pair<State, double>> ordered(states.begin(), states.end());
    std::sort(ordered.begin(), ordered.end());
    for (const auto& [state, probability] : ordered) {
        null.spread[spread_of(state)] += probability;
        null.range[state.front() - state.back()] += probability;
    }
    null.cases = static_cast<std::int64_t>(states.size());
    return true;
}

void draw(RankSumNull& null, std::uint64_t seed) {
    constexpr std::size_t draws = 1'000'000;
    const PlaceScores scores = place_scores(null.designs, null.has_least);
    const auto designs = static_cast<std::size_t>(null.designs);
    std::vector<std::vector<int>> choices;
    for (const Ballot& ballot :
         ballot_law(std::vector<double>(designs, 1.0), null.has_least).ballots) {
        std::vector<int> gains(designs, scores.other);
        gains[static_cast<std::size_t>(ballot.best)] = scores.best;
        gains[static_cast<std::size_t>(ballot.second)] = scores.second;
        if (null.has_least) gains[static_cast<std::size_t>(ballot.least)] = scores.least;
        choices.push_back(std::move(gains));
    }
    std::vector<std::pair<std::int64_t, int>> drawn(draws);
    draw_sums(choices,
              null.evaluators,
              draws,
              seed,
              1,
              [&](std::size_t index, const std::vector<int>& sums) {
                  const auto [low, high] = std::minmax_element(sums.begin(), sums.end());
                  drawn[index] = {spread_of(sums), *high - *low};
              });
    for (const auto& [spread, range] : drawn) {
        null.spread[spread] += 1.0;
        null.range[range] += 1.0;
    }
    for (auto& [spread, probability] : null.spread) probability /= static_cast<double>(draws);
    for (auto& [range, probability] : null.range) probability /= static_cast<double>(draws);
    null.cases = static_cast<std::int64_t>(draws);
}

}  // namespace

RankSumNull rank_sum_null(
    int designs, int evaluators, bool has_least, std::uint64_t seed, std::int64_t most_steps) {
    RankSumNull null;
    null.designs = designs;
    null.evaluators = evaluators;
    null.has_least = has_least;
    if (!convolve(null, most_steps)) {
        null.method = Method::drawn;
        draw(null, seed);
    }
    return null;
}

namespace {

/// sum over all ordered pairs of (difference)^2
double squared_differences(const std::vector<double>& values) {
    double sum = 0.0, squares = 0.0;
    for (const double value : values) {
        sum += value;
        squares += value * value;
    }
    return 2.0 * (static_cast<double>(values.size()) * squares - sum * sum);
}

}  // namespace

std::optional<double> krippendorff_alpha(const std::vector<std::vector<double>>& values) {
    std::vector<double> pairable;
    double observed = 0.0;
    for (const auto& unit : values) {
        if (unit.size() < 2) continue;
        observed += squared_differences(unit) / (static_cast<double>(unit.size()) - 1.0);
        pairable.insert(pairable.end(), unit.begin(), unit.end());
    }
    if (pairable.empty()) return std::nullopt;
    const double expected =
        squared_differences(pairable) / (static_cast<double>(pairable.size()) - 1.0);
    if (!(expected > 0.0)) return std::nullopt;
    return 1.0 - observed / expected;
}

std::vector<std::vector<double>> ranks_given(const std::vector<Ballot>& ballots, int designs) {
    std::vector<std::vector<double>> ranks(static_cast<std::size_t>(designs));
    for (const Ballot& ballot : ballots) {
        if (ballot.best < 0) continue;
        const double above = ballot.second < 0 ? 1.0 : 2.0;
        const double below = ballot.least < 0 ? designs : designs - 1.0;
        for (int i = 0; i < designs; ++i) {
            double rank = 0.5 * (above + 1.0 + below);
            if (i == ballot.best) rank = 1.0;
            if (i == ballot.second) rank = 2.0;
            if (i == ballot.least) rank = designs;
            ranks[static_cast<std::size_t>(i)].push_back(rank);
        }
    }
    return ranks;
}

std::vector<std::vector<double>> ranks_given(const VoteCounts& counts) {
    std::vector<std::vector<double>> ranks;
    const double k = counts.designs();
    const auto evaluators = static_cast<std::size_t>(counts.evaluators());
    for (std::size_t i = 0; i < counts.best.size(); ++i) {
        std::vector<double> given;
        given.insert(given.end(), static_cast<std::size_t>(counts.best[i]), 1.0);
        given.insert(given.end(), static_cast<std::size_t>(counts.second[i]), 2.0);
        if (counts.has_least())
            given.insert(given.end(), static_cast<std::size_t>(counts.least[i]), k);
        given.resize(evaluators, counts.has_least() ? 0.5 * (k + 2.0) : 0.5 * (k + 3.0));
        ranks.push_back(std::move(given));
    }
    return ranks;
}

namespace {

std::int64_t squares_of(const std::vector<int>& counts) {
    std::int64_t squares = 0;
    for (const std::int64_t count : counts) squares += count * count;
    return squares;
}

/// In how many ways at most `parts` counts add up to `sum`, order aside; no more than `most` + 1.
std::int64_t partitions(int sum, int parts, std::int64_t most) {
    // Of a sum into parts of at most `parts`, which are as many.
    std::vector<std::int64_t> ways(static_cast<std::size_t>(sum) + 1, 0);
    ways[0] = 1;
    for (int part = 1; part <= parts; ++part) {
        for (int s = part; s <= sum; ++s) {
            auto& way = ways[static_cast<std::size_t>(s)];
            way = std::min(most + 1, way + ways[static_cast<std::size_t>(s - part)]);
        }
    }
    return ways.back();
}

/// Goes through the counts in falling order and adds up the probability of those with as large a
/// sum of squares.
class Outcomes {
  public:
    Outcomes(int evaluators, std::size_t designs, std::int64_t squares)
        : counts_(designs),
          squares_(squares),
          log_factorial_(static_cast<std::size_t>(evaluators) + 1) {
        for (std::size_t n = 1; n < log_factorial_.size(); ++n) {
            log_factorial_[n] = log_factorial_[n - 1] + std::log(static_cast<double>(n));
        }
        log_all_ = log_factorial_.back() - evaluators * std::log(static_cast<double>(designs));
        choose(0, evaluators, evaluators);
    }
    double probability() const { return std::min(sum_, 1.0); }

  private:
    void choose(std::size_t at, int left, int most) {
        if (at + 1 == counts_.size()) {
            counts_[at] = left;
            add();
            return;
        }
        const auto places = static_cast<int>(counts_.size() - at);
        for (int count = std::min(left, most); count * places >= left; --count) {
            counts_[at] = count;
            // The last one takes what is left, which may not be more than the one before.
            if (at + 2 == counts_.size() && left - count > count) break;
            choose(at + 1, left - count, count);
        }
    }
    void add() {
        if (squares_of(counts_) < squares_) return;
        double log_probability = log_all_;
        std::size_t alike = 0;
        log_probability += std::lgamma(static_cast<double>(counts_.size()) + 1.0);
        for (std::size_t i = 0; i < counts_.size(); ++i) {
            log_probability -= log_factorial_[static_cast<std::size_t>(counts_[i])];
            alike = i > 0 && counts_[i] == counts_[i - 1] ? alike + 1 : 1;
            log_probability -= std::log(static_cast<double>(alike));
        }
        sum_ += std::exp(log_probability);
    }

    std::vector<int> counts_;
    std::int64_t squares_;
    std::vector<double> log_factorial_;
    double log_all_ = 0.0, sum_ = 0.0;
};

double drawn_p(const std::vector<int>& best,
               int evaluators,
               std::uint64_t seed,
               std::size_t draws) {
    const std::int64_t squares = squares_of(best);
    std::vector<std::vector<int>> choices(best.size(), std::vector<int>(best.size(), 0));
    for (std::size_t i = 0; i < best.size(); ++i) choices[i][i] = 1;
    std::vector<char> as_large(draws);
    draw_sums(choices,
              evaluators,
              draws,
              seed,
              2,
              [&](std::size_t index, const std::vector<int>& counts) {
                  as_large[index] = squares_of(counts) >= squares ? 1 : 0;
              });
    const int hits = std::accumulate(as_large.begin(), as_large.end(), 0);
    return (hits + 1.0) / (static_cast<double>(draws) + 1.0);
}

}  // namespace

BestVotesTest best_votes_test(const std::vector<int>& best,
                              std::uint64_t seed,
                              std::int64_t most_states) {
    const int evaluators = std::accumulate(best.begin(), best.end(), 0);
    const auto designs = static_cast<int>(best.size());
    BestVotesTest test;
    if (evaluators > 0) {
        const double expected = static_cast<double>(evaluators) / designs;
        test.chi_square = static_cast<double>(squares_of(best)) / expected - evaluators;
    }
    test.asymptotic_p = chi_square_tail(test.chi_square, designs - 1);
    test.cases = partitions(evaluators, designs, most_states);
    if (test.cases <= most_states) {
        test.p = Outcomes(evaluators, best.size(), squares_of(best)).probability();
        return test;
    }
    constexpr std::size_t draws = 1'000'000;
    test.method = Method::drawn;
    test.cases = static_cast<std::int64_t>(draws);
    test.p = drawn_p(best, evaluators, seed, draws);
    return test;
}

}  // namespace livery
