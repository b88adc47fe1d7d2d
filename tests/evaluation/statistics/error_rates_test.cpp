// How often the verdicts are wrong, over drawn rounds, duels and answers in which it is known that
// they are.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <map>
#include <numeric>

#include <gtest/gtest.h>

#include "core/random.h"
#include "evaluation/statistics/duel_statistics.h"
#include "evaluation/statistics/figures.h"
#include "evaluation/statistics/pairs.h"
#include "evaluation/statistics/scale_statistics.h"
#include "evaluation/statistics/table3.h"
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
            return predicted_wins(data, counts.evaluators(), 1)
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
        const auto said = judge_round(count_ballots(ballots, designs, has_least));
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
        const auto sums = rank_sums(count_ballots(draw_round(law, 10, random), 4, false));
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

/// Log-worths drawn from a normal distribution.
BallotLaw drawn_law(int designs, double deviation, Random& random) {
    std::vector<double> worths;
    for (int i = 0; i < designs; ++i) {
        const double radius = std::sqrt(-2.0 * std::log(1.0 - random.uniform()));
        worths.push_back(std::exp(deviation * radius * std::cos(2.0 * M_PI * random.uniform())));
    }
    const double sum = std::accumulate(worths.begin(), worths.end(), 0.0);
    for (double& worth : worths) worth /= sum;
    return ballot_law(worths, false);
}

/// Designs liked unalike, whose log-worths have a deviation of 1 or 2: who leads a round of ten or
/// twenty is said to be first among as many others as often as it is.
TEST(PredictedWins, NightlyAreTrueAsOftenAsTheySay) {
    struct Rounds {
        int designs, evaluators;
        double deviation;
    };
    for (const Rounds& each : {Rounds{4, 10, 1.0}, {4, 20, 1.0}, {4, 10, 2.0}, {3, 8, 1.0}}) {
        constexpr std::size_t kRounds = 600;
        std::vector<double> said(kRounds), would_say(kRounds), is(kRounds);
        for_draws(kRounds, 20261128, 9, [&](Random& random, std::size_t k) {
            const BallotLaw truth = drawn_law(each.designs, each.deviation, random);
            const auto ballots = draw_round(truth, each.evaluators, random);
            const LuceData data = luce_data(count_ballots(ballots, each.designs, false), &ballots);
            const LuceFit fit = fit_luce(data);
            const auto leader = static_cast<std::size_t>(by_worth(fit)[0]);
            said[k] = predicted_wins(data, each.evaluators, k).first[leader];
            would_say[k] =
                win_probabilities(ballot_law(worths_of(fit), false), each.evaluators, 0, 1, k)
                    .first[leader];
            is[k] = win_probabilities(truth, each.evaluators, 0, 1, k).first[leader];
        });
        const auto mean = [](const std::vector<double>& values) {
            return std::accumulate(values.begin(), values.end(), 0.0) /
                   static_cast<double>(values.size());
        };
        double sure = 0.0, sure_said = 0.0, sure_is = 0.0;
        for (std::size_t k = 0; k < kRounds; ++k) {
            if (said[k] < 0.9) continue;
            sure += 1.0;
            sure_said += said[k];
            sure_is += is[k];
        }
        std::printf(
            "    %d designs, %d evaluators, deviation %.0f: said %.3f, true %.3f (of fitted "
            "worths %.3f); where it says .9 or more: %.3f, true %.3f\n",
            each.designs,
            each.evaluators,
            each.deviation,
            mean(said),
            mean(is),
            mean(would_say),
            sure_said / sure,
            sure_is / sure);
        EXPECT_NEAR(mean(said), mean(is), 0.03);
        // Of a hundred or two of them: noise of 1.5 points.
        EXPECT_NEAR(sure_said / sure, sure_is / sure, 0.05);
    }
}

/// Rounds of which a design has no vote, or one all for best, are fitted with the ghost: how often
/// their intervals hold the truth. Where all are liked alike such a round is chance in itself.
TEST(GhostIntervals, NightlyHoldTheTruthUnlessAllAreLikedAlike) {
    const auto share_held = [](int evaluators, double deviation) {
        double pairs = 0.0, held = 0.0;
        Random random(20261128, 10);
        for (int round = 0; round < 4000; ++round) {
            const BallotLaw truth = drawn_law(4, deviation, random);
            const auto ballots = draw_round(truth, evaluators, random);
            const VoteCounts counts = count_ballots(ballots, 4, false);
            if (!needs_ghost(counts)) continue;
            const LuceData data = luce_data(counts, &ballots);
            std::array<double, 4> worth{};
            for (std::size_t k = 0; k < truth.ballots.size(); ++k)
                worth[static_cast<std::size_t>(truth.ballots[k].best)] += truth.probabilities[k];
            for (const PairComparison& pair : compare_pairs(data, fit_luce(data))) {
                const double odds = worth[static_cast<std::size_t>(pair.a)] /
                                    worth[static_cast<std::size_t>(pair.b)];
                pairs += 1.0;
                held += odds >= pair.low && odds <= pair.high ? 1.0 : 0.0;
            }
        }
        std::printf(
            "    %d evaluators, deviation %.1f: of %.0f intervals with a ghost %.1f%% hold\n",
            evaluators,
            deviation,
            pairs,
            100.0 * held / pairs);
        return held / pairs;
    };
    for (const int evaluators : {6, 10, 20}) EXPECT_GT(share_held(evaluators, 2.0), 0.93);
    EXPECT_GT(share_held(8, 1.0), 0.93);
    EXPECT_LT(share_held(6, 0.0), 0.8) << "they need no warning any more";
}

/// How often the verdict is wrong, over 10,000 duels of evaluators without a preference in common:
/// each chooses the first look with a chance of its own, which is as often below a half as above.
TEST(DuelErrorRates, StayWithinFivePercentWhoeverGuessesAndWhoeverIsMissing) {
    constexpr int duels = 10'000;
    constexpr std::uint64_t seed = 20150101;
    // Three standard errors of a rate of .05
    const double most = 0.05 + 3.0 * std::sqrt(0.05 * 0.95 / duels);
    const double even[] = {0.5, 0.5}, camps[] = {0.03, 0.97}, leanings[] = {0.3, 0.7};
    for (const auto& [name, chances] :
         {std::pair{"guessers", even}, {"two camps", camps}, {"leanings", leanings}}) {
        for (const int evaluators : {8, 10, 12, 24, 40}) {
            for (const double missing : {0.0, 0.2}) {
                Random random(seed, static_cast<std::uint64_t>(evaluators));
                int preferred = 0, consistent = 0;
                for (int duel = 0; duel < duels; ++duel) {
                    std::vector<DuelAnswers> answers;
                    for (int k = 0; k < evaluators; ++k) {
                        const double chance = chances[random.below(2)];
                        DuelAnswers& own = answers.emplace_back();
                        for (int repeat = 0; repeat < 3; ++repeat) {
                            const bool absent = random.uniform() < missing;
                            const int choice = random.uniform() < chance ? 0 : 1;
                            own.push_back(absent ? -1 : choice);
                        }
                    }
                    const DuelStatistics found = duel_statistics(answers, 3);
                    preferred += found.kind == DuelVerdictKind::preferred ? 1 : 0;
                    consistent += found.consistency_p <= 0.05 ? 1 : 0;
                }
                const double rate = static_cast<double>(preferred) / duels;
                const double guessed = static_cast<double>(consistent) / duels;
                std::cout << name << ", " << evaluators << " evaluators, " << 100.0 * missing
                          << "% of answers missing: \"preferred\" in " << 100.0 * rate
                          << "%, \"more than guessing\" in " << 100.0 * guessed << "%\n";
                EXPECT_LE(rate, most);
                if (chances == even) {
                    EXPECT_LE(guessed, most);
                }
            }
        }
    }
}

constexpr std::uint64_t kScaleSeed = 20150101;
const std::vector<SemanticScale> kScales = {
    {"cheap", "precious"}, {"cold", "warm"}, {"plain", "striking"}};
const std::vector<std::string> kNames = {"a", "b", "c", "d"};

/// Every evaluator has a middle of his own and steps around it, the same for all looks.
std::vector<ScaleAnswers> drawn_answers(int evaluators, Random& random) {
    std::vector<ScaleAnswers> answers;
    for (int k = 0; k < evaluators; ++k) {
        const double middle = 2.5 + 3.0 * random.uniform();
        ScaleAnswers& own = answers.emplace_back();
        for (std::size_t design = 0; design < kNames.size(); ++design) {
            auto& steps = own.emplace_back();
            for (std::size_t scale = 0; scale < kScales.size(); ++scale) {
                const double at = middle + 1.2 * random.normal();
                steps.push_back(std::clamp(static_cast<int>(std::lround(at)), 1, 7));
            }
        }
    }
    return answers;
}

TEST(ScaleErrorRates, NightlyAFamilyOfScalesIsCalledDifferentInFivePercentAtMost) {
    constexpr int rounds = 2000;
    // Three standard errors of a rate of .05 in 2000 rounds
    const double most = 0.05 + 3.0 * std::sqrt(0.05 * 0.95 / rounds);
    for (const int evaluators : {4, 10, 24}) {
        Random random(kScaleSeed, static_cast<std::uint64_t>(evaluators));
        int different = 0;
        for (int round = 0; round < rounds; ++round) {
            const auto found = scale_statistics(drawn_answers(evaluators, random),
                                                kScales,
                                                kNames,
                                                static_cast<std::uint64_t>(round),
                                                399);
            different += std::any_of(found.scales.begin(),
                                     found.scales.end(),
                                     [](const auto& figures) { return figures.holm_p <= 0.05; })
                             ? 1
                             : 0;
        }
        const double rate = static_cast<double>(different) / rounds;
        std::cout << evaluators << " evaluators, three scales, no look differs: one is said to in "
                  << 100.0 * rate << "%\n";
        EXPECT_LE(rate, most);
    }
}

/// Plain percentiles of ten evaluators would hold the truth in about 90%; fewer than eight are
/// given no interval, since the expanded ones of six hold it in 91%.
TEST(ScaleErrorRates, NightlyIntervalsOfMeansHoldAboutAsOftenAsTheySay) {
    constexpr int rounds = 2000;
    for (const int evaluators : {8, 10, 24}) {
        // The truth, from many
        Random random(kScaleSeed, 99);
        double truth = 0.0;
        const auto many = drawn_answers(40'000, random);
        for (const ScaleAnswers& own : many) truth += own[0][0] / 40'000.0;
        int holds = 0;
        for (int round = 0; round < rounds; ++round) {
            const auto found = scale_statistics(drawn_answers(evaluators, random),
                                                kScales,
                                                kNames,
                                                static_cast<std::uint64_t>(round),
                                                399);
            const Interval& interval = found.scales[0].looks[0].interval;
            holds += interval.low <= truth && truth <= interval.high ? 1 : 0;
        }
        const double rate = static_cast<double>(holds) / rounds;
        std::cout << evaluators << " evaluators: the 95% interval of a mean holds the truth in "
                  << 100.0 * rate << "%\n";
        // Means of few whole steps take few values: a percent of room, and three standard errors.
        EXPECT_GE(rate, 0.94 - 3.0 * std::sqrt(0.95 * 0.05 / rounds));
        EXPECT_LE(rate, 0.99);
    }
}

}  // namespace
}  // namespace livery
