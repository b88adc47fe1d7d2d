// Worths: against another way of finding them, and what must hold of any.

#include "evaluation/statistics/plackett_luce.h"

#include <cmath>
#include <numeric>

#include <gtest/gtest.h>

#include "evaluation/statistics/pairs.h"
#include "evaluation/statistics/table3.h"

namespace livery {
namespace {

std::vector<Ballot> some_ballots(int designs, int evaluators, bool has_least, int seed) {
    Random random(static_cast<std::uint64_t>(seed));
    std::vector<double> worths;
    for (int i = 0; i < designs; ++i) worths.push_back(1.0 + i);
    return draw_round(ballot_law(worths, has_least), evaluators, random);
}

/// Hunter's (2004) minorise-maximise iteration, in the form for best and second best, with the
/// ghost as one more opponent of worth 1.
std::vector<double> mm_worths(const VoteCounts& counts, bool ghost) {
    const std::size_t designs = counts.best.size();
    std::vector<double> worths(designs, 1.0);
    for (int round = 0; round < 200000; ++round) {
        const double sum = std::accumulate(worths.begin(), worths.end(), 0.0);
        double moved = 0.0;
        std::vector<double> next(designs);
        for (std::size_t i = 0; i < designs; ++i) {
            double weight = counts.evaluators() / sum;
            for (std::size_t j = 0; j < designs; ++j) {
                if (j != i && counts.best[j] > 0) weight += counts.best[j] / (sum - worths[j]);
            }
            double named = counts.best[i] + counts.second[i];
            if (ghost) {
                named += 0.5;
                weight += 1.0 / (worths[i] + 1.0);
            }
            next[i] = named / weight;
            moved = std::max(moved, std::abs(next[i] / worths[i] - 1.0));
        }
        worths = next;
        if (moved < 1e-13) break;
    }
    const double sum = std::accumulate(worths.begin(), worths.end(), 0.0);
    for (double& worth : worths) worth /= sum;
    return worths;
}

TEST(PlackettLuce, IsWhereTheIterationOfHunterEnds) {
    std::vector<VoteCounts> rounds = {table3()};
    for (int designs = 2; designs <= 8; ++designs) {
        for (const int evaluators : {1, 3, 10, 60}) {
            rounds.push_back(
                counts_of(some_ballots(designs, evaluators, false, 7), designs, false));
        }
    }
    int with_ghost = 0;
    for (const VoteCounts& counts : rounds) {
        const LuceData data = luce_data(counts);
        with_ghost += data.ghost > 0.0 ? 1 : 0;
        const auto worths = worths_of(fit_luce(data)),
                   expected = mm_worths(counts, data.ghost > 0.0);
        for (std::size_t i = 0; i < worths.size(); ++i) {
            EXPECT_NEAR(worths[i], expected[i], 2e-8)
                << worths.size() << " designs, " << counts.evaluators();
        }
    }
    EXPECT_GT(with_ghost, 5);
    EXPECT_LT(with_ghost, static_cast<int>(rounds.size()) - 5);
}

TEST(PlackettLuce, KnowsWhenThereIsNoMaximum) {
    EXPECT_FALSE(needs_ghost(table3()));
    EXPECT_TRUE(needs_ghost({{10, 0, 0}, {0, 6, 4}}));  // nobody but a is best
    EXPECT_TRUE(needs_ghost({{5, 5, 0}, {5, 5, 0}}));   // c has no vote
    EXPECT_TRUE(needs_ghost({{0, 0, 0}, {0, 0, 0}}));
    EXPECT_FALSE(needs_ghost({{9, 1, 0}, {0, 0, 10}}));
    EXPECT_FALSE(needs_ghost({{9, 1}, {1, 9}}));
    EXPECT_TRUE(needs_ghost({{10, 0}, {0, 10}}));
}

TEST(PlackettLuce, FollowsTheDesignsWhereverTheyStand) {
    const VoteCounts counts{{1, 6, 1, 2, 0}, {0, 3, 2, 4, 1}, {5, 0, 3, 0, 2}};
    const std::vector<std::size_t> places = {3, 0, 4, 2, 1};
    VoteCounts moved = counts;
    for (std::size_t i = 0; i < places.size(); ++i) {
        moved.best[places[i]] = counts.best[i];
        moved.second[places[i]] = counts.second[i];
        moved.least[places[i]] = counts.least[i];
    }
    const LuceData data = luce_data(counts), other = luce_data(moved);
    const LuceFit fit = fit_luce(data), fit_moved = fit_luce(other);
    EXPECT_NEAR(fit.log_likelihood, fit_moved.log_likelihood, 1e-8);
    for (std::size_t i = 0; i < places.size(); ++i) {
        EXPECT_NEAR(worths_of(fit)[i], worths_of(fit_moved)[places[i]], 1e-8);
    }
    const PairComparison pair = compare_pair(data, fit, 1, 3);
    const PairComparison turned =
        compare_pair(other, fit_moved, static_cast<int>(places[3]), static_cast<int>(places[1]));
    EXPECT_NEAR(pair.low * turned.high, 1.0, 1e-6);
    EXPECT_NEAR(pair.high * turned.low, 1.0, 1e-6);
    EXPECT_NEAR(pair.p, turned.p, 1e-8);
}

TEST(PlackettLuce, TheIntervalIsWhereTheLikelihoodHasFallen) {
    for (const bool has_least : {false, true}) {
        const auto ballots = some_ballots(5, 12, has_least, 3);
        const LuceData data = luce_data(counts_of(ballots, 5, has_least), &ballots);
        const LuceFit fit = fit_luce(data);
        for (const PairComparison& pair : compare_pairs(data, fit)) {
            for (const double odds : {pair.low, pair.high}) {
                EXPECT_NEAR(deviance(data, fit, {pair.a, pair.b, std::log(odds)}), 3.841459, 1e-5);
            }
            EXPECT_LT(pair.low, pair.odds);
            EXPECT_GT(pair.high, pair.odds);
            // It excludes 1 exactly when the test says .05.
            EXPECT_EQ(pair.low > 1.0 || pair.high < 1.0, pair.p < 0.05);
        }
    }
}

TEST(PlackettLuce, HeldOddsAreHeld) {
    const LuceData data = luce_data(table3());
    for (const double log_odds : {-60.0, -3.0, 0.0, 1.0, 60.0}) {
        const LuceFit fit = fit_luce(data, HeldOdds{0, 2, log_odds});
        EXPECT_NEAR(fit.log_worths[0] - fit.log_worths[2], log_odds, 1e-9);
        EXPECT_LE(fit.log_likelihood, fit_luce(data).log_likelihood + 1e-9);
    }
}

TEST(PlackettLuce, ALeastOfThreeTellsNothingNew) {
    // With three designs it is the one that is left.
    const VoteCounts plain{{5, 3, 2}, {3, 4, 3}};
    VoteCounts with_least = plain;
    with_least.least = {2, 3, 5};
    const auto a = worths_of(fit_luce(luce_data(plain)));
    const auto b = worths_of(fit_luce(luce_data(with_least)));
    for (std::size_t i = 0; i < a.size(); ++i) EXPECT_NEAR(a[i], b[i], 1e-8);
}

TEST(PlackettLuce, FindsTheWorthsThatManyBallotsComeFrom) {
    const std::vector<double> worths = {0.4, 0.1, 0.2, 0.05, 0.25};
    for (const bool has_least : {false, true}) {
        const LuceData data = luce_data(expected_votes(ballot_law(worths, has_least), 100.0));
        const auto fitted = worths_of(fit_luce(data));
        for (std::size_t i = 0; i < worths.size(); ++i) {
            EXPECT_NEAR(fitted[i], worths[i], has_least ? 1e-7 : 1e-9);
        }
    }
}

TEST(PlackettLuce, TheErrorIsTheCurvatureOfTheDeviance) {
    const LuceData data = luce_data(table3());
    const LuceFit fit = fit_luce(data);
    const double error = standard_error(data, fit, 1, 3);
    const double log_odds = fit.log_worths[1] - fit.log_worths[3], step = 0.02;
    const double curvature = (deviance(data, fit, {1, 3, log_odds + step}) +
                              deviance(data, fit, {1, 3, log_odds - step})) /
                             (2.0 * step * step);
    EXPECT_NEAR(1.0 / std::sqrt(curvature), error, 1e-3 * error);
}

TEST(ExpectedPairs, HaveTheCountsAndNoDesignTwice) {
    const VoteCounts counts{{1, 6, 1, 2}, {0, 3, 2, 5}};
    const auto pairs = expected_pairs(counts);
    for (std::size_t i = 0; i < 4; ++i) {
        EXPECT_EQ(pairs[i * 4 + i], 0.0);
        double best = 0.0, second = 0.0;
        for (std::size_t j = 0; j < 4; ++j) {
            best += pairs[i * 4 + j];
            second += pairs[j * 4 + i];
        }
        EXPECT_NEAR(best, counts.best[i], 2e-3);
        EXPECT_NEAR(second, counts.second[i], 2e-3);
    }
    // Where only one table is possible, that.
    const auto only = expected_pairs({{4, 0, 1}, {0, 5, 0}});
    EXPECT_NEAR(only[0 * 3 + 1], 4.0, 2e-3);
    EXPECT_NEAR(only[2 * 3 + 1], 1.0, 2e-3);
}

}  // namespace
}  // namespace livery
