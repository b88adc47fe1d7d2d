// How often the verdicts are wrong, over drawn rounds in which it is known that they are.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>

#include <gtest/gtest.h>

#include "evaluation/statistics/pairs.h"
#include "evaluation/statistics/power.h"
#include "evaluation/statistics/table3.h"
#include "evaluation/statistics/tails.h"
#include "evaluation/statistics/verdict.h"
#include "evaluation/statistics/winners.h"

namespace livery {
namespace {

constexpr std::uint64_t kVerdictSeed = 20150101;

struct Rates {
    double preference = 0.0;  ///< any verdict but "no preference"
    double apart = 0.0;       ///< any pair told apart by its rank sums
    double winner = 0.0;      ///< a clear winner
};

/// The verdict on counts alone, remembered: few counts come about often.
class Judge {
  public:
    Judge(int designs, int evaluators, bool has_least)
        : null_(rank_sum_null(designs, evaluators, has_least, 1)),
          threshold_(range_threshold(null_)) {}

    /// Preference, apart, winner.
    std::array<bool, 3> operator()(const VoteCounts& counts) {
        std::vector<int> key = counts.best;
        key.insert(key.end(), counts.second.begin(), counts.second.end());
        key.insert(key.end(), counts.least.begin(), counts.least.end());
        const auto [place, is_new] = known_.try_emplace(key);
        if (!is_new) return place->second;
        const LuceData data = luce_data(counts);
        const LuceFit fit = fit_luce(data);
        const auto win_probability = [&](int design) {
            const BallotLaw law = ballot_law(worths_of(fit), counts.has_least());
            const int evaluators = counts.evaluators();
            return win_probabilities(law, evaluators, 0, 1, 1)
                .first[static_cast<std::size_t>(design)];
        };
        const Verdict verdict = judge(counts, data, fit, null_, win_probability, 1);
        const auto sums = rank_sums(counts);
        const auto [low, high] = std::minmax_element(sums.begin(), sums.end());
        place->second = {verdict.kind != VerdictKind::no_preference,
                         threshold_ && *high - *low >= *threshold_,
                         verdict.kind == VerdictKind::clear_winner};
        return place->second;
    }

  private:
    RankSumNull null_;
    std::optional<double> threshold_;
    std::map<std::vector<int>, std::array<bool, 3>> known_;
};

Rates rates(const std::vector<double>& worths, int evaluators, bool has_least, int rounds) {
    const BallotLaw law = ballot_law(worths, has_least);
    const auto designs = static_cast<int>(worths.size());
    Judge judge_round(designs, evaluators, has_least);
    Random random(kVerdictSeed);
    std::array<int, 3> told{};
    for (int round = 0; round < rounds; ++round) {
        const auto ballots = draw_round(law, evaluators, random);
        const auto said = judge_round(count_drawn(ballots, designs, has_least));
        for (std::size_t k = 0; k < told.size(); ++k) told[k] += said[k] ? 1 : 0;
    }
    const double share = 1.0 / rounds;
    return {told[0] * share, told[1] * share, told[2] * share};
}

/// At most .05 but for what chance adds in so many rounds.
double allowed(int rounds) { return 0.05 + 3.0 * std::sqrt(0.05 * 0.95 / rounds); }

void print(const char* name, int rounds, const Rates& found) {
    std::printf("seed %llu, %d rounds, %s: preference %.4f, a pair apart %.4f, clear winner %.4f\n",
                static_cast<unsigned long long>(kVerdictSeed),
                rounds,
                name,
                found.preference,
                found.apart,
                found.winner);
}

TEST(ErrorRates, NightlyWithoutAnyPreference) {
    constexpr int rounds = 10000;
    struct Case {
        const char* name;
        int designs, evaluators;
        bool has_least;
    };
    for (const Case& one : {Case{"4 designs, 10 evaluators", 4, 10, false},
                            Case{"2 designs, 10 evaluators", 2, 10, false},
                            Case{"3 designs, 10 evaluators", 3, 10, false},
                            Case{"4 designs, 10 evaluators, least", 4, 10, true}}) {
        const std::vector<double> worths(static_cast<std::size_t>(one.designs), 1.0);
        const Rates found = rates(worths, one.evaluators, one.has_least, rounds);
        print(one.name, rounds, found);
        EXPECT_LE(found.preference, allowed(rounds)) << one.name;
        EXPECT_LE(found.apart, allowed(rounds)) << one.name;
        EXPECT_LE(found.winner, allowed(rounds)) << one.name;
        // The exact tests reach their level as near as whole votes let them.
        EXPECT_GT(found.preference, one.designs == 4 ? 0.02 : 0.005) << one.name;
    }
}

TEST(ErrorRates, OfTheExactTestIsAtMostItsLevel) {
    for (int designs = 2; designs <= 5; ++designs) {
        for (int evaluators = 1; evaluators <= 12; ++evaluators) {
            const RankSumNull null = rank_sum_null(designs, evaluators, false, 1);
            ASSERT_EQ(null.method, Method::exact);
            double tail = 0.0, size = 0.0;
            for (auto at = null.spread.rbegin(); at != null.spread.rend(); ++at) {
                tail += at->second;
                if (tail <= 0.05) size = tail;
            }
            EXPECT_NEAR(tail, 1.0, 1e-9);
            EXPECT_LE(size, 0.05);
            EXPECT_GT(size, designs == 4 && evaluators == 10 ? 0.048 : -1.0);
        }
    }
}

TEST(ErrorRates, NightlyBetweenTwoThatAreEquallyGood) {
    constexpr int rounds = 1000;
    for (const double others : {0.1, 0.01}) {
        const Rates found = rates({1.0, 1.0, others, others}, 10, false, rounds);
        print("two equal leaders", rounds, found);
        EXPECT_LE(found.winner, allowed(rounds)) << others;
    }
}

TEST(ErrorRates, TheThresholdHoldsItsLevelInDrawnRounds) {
    constexpr int rounds = 100000;
    const BallotLaw law = ballot_law({1.0, 1.0, 1.0, 1.0}, false);
    Random random(kVerdictSeed);
    int at_threshold = 0, below = 0;
    for (int round = 0; round < rounds; ++round) {
        const auto sums = rank_sums(count_drawn(draw_round(law, 10, random), 4, false));
        const auto [low, high] = std::minmax_element(sums.begin(), sums.end());
        at_threshold += *high - *low >= 14.5 ? 1 : 0;
        below += *high - *low >= 14.0 ? 1 : 0;
    }
    std::printf("seed %llu, %d rounds: range of 14.5 or more in %.4f, of 14 or more in %.4f\n",
                static_cast<unsigned long long>(kVerdictSeed),
                rounds,
                at_threshold / double{rounds},
                below / double{rounds});
    EXPECT_LE(at_threshold / double{rounds}, allowed(rounds));
    EXPECT_GT(below / double{rounds}, 0.05);
}

TEST(ErrorRates, WinnersAreFoundWhereThereAreSome) {
    const Rates found = rates({8.0, 1.0, 1.0, 1.0}, 10, false, 100);
    print("one of eight times the worth", 100, found);
    EXPECT_GT(found.winner, 0.3);
    EXPECT_GT(found.preference, 0.9);
}

}  // namespace
}  // namespace livery
