#include <algorithm>
#include <string>
#include <unordered_map>

#include "evaluation/statistics/ballot_law.h"
#include "evaluation/statistics/drawn_sums.h"
#include "evaluation/statistics/rank_sums.h"

namespace livery {

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

}  // namespace livery
