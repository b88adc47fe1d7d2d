// Where a formula, or a published example, says what must come out.

#include <cmath>

#include <gtest/gtest.h>

#include "evaluation/statistics/figures.h"
#include "evaluation/statistics/pairs.h"
#include "evaluation/statistics/preference_tests.h"
#include "evaluation/statistics/winners.h"

namespace livery {
namespace {

double binomial(int n, int k, double p) {
    return std::exp(std::lgamma(n + 1.0) - std::lgamma(k + 1.0) - std::lgamma(n - k + 1.0)) *
           std::pow(p, k) * std::pow(1.0 - p, n - k);
}

TEST(Tails, ChiSquareAndWilson) {
    // Printed tables: 3.841 and 11.345 are the 95% and 99% points of one and three degrees.
    EXPECT_NEAR(chi_square_tail(3.841458820694124, 1), 0.05, 1e-12);
    EXPECT_NEAR(chi_square_tail(11.344866730144373, 3), 0.01, 1e-12);
    for (const double x : {0.0, 0.1, 2.0, 40.0, 900.0}) {
        EXPECT_NEAR(chi_square_tail(x, 2), std::exp(-0.5 * x), 1e-14) << x;
    }
    EXPECT_EQ(chi_square_tail(1e6, 3), 0.0);
    EXPECT_EQ(chi_square_tail(-1.0, 3), 1.0);
    // Newcombe (1998), table I: 81 of 263, 15 of 148, 0 of 20, 1 of 29.
    const auto check = [](int count, int of, double low, double high) {
        const Interval interval = wilson_interval(count, of);
        EXPECT_NEAR(interval.low, low, 5e-5) << count << " of " << of;
        EXPECT_NEAR(interval.high, high, 5e-5) << count << " of " << of;
    };
    check(81, 263, 0.2553, 0.3662);
    check(15, 148, 0.0624, 0.1605);
    check(0, 20, 0.0, 0.1611);
    check(1, 29, 0.0061, 0.1718);
    check(20, 20, 1.0 - 0.1611, 1.0);
    check(0, 0, 0.0, 1.0);
}

TEST(TwoDesigns, AreBradleyAndTerrys) {
    for (const int wins : {1, 4, 7, 9}) {
        const int n = 10, losses = n - wins;
        const VoteCounts counts{{wins, losses}, {losses, wins}};
        const LuceData data = luce_data(counts);
        const LuceFit fit = fit_luce(data);
        const double share = wins / 10.0;
        EXPECT_NEAR(worths_of(fit)[0], share, 1e-10);
        const PairComparison pair = compare_pair(data, fit, 0, 1);
        EXPECT_NEAR(pair.odds, share / (1.0 - share), 1e-9);
        const double error = std::sqrt(1.0 / wins + 1.0 / losses);
        EXPECT_NEAR(
            pair.wald_high, pair.odds * std::exp(kNormal975 * error), 1e-7 * pair.wald_high);
        const double ratio =
            2.0 * (wins * std::log(2.0 * share) + losses * std::log(2.0 - 2.0 * share));
        EXPECT_NEAR(pair.p, chi_square_tail(ratio, 1), 1e-9);
        // At the ends of the interval the likelihood has fallen by half of 3.841.
        for (const double odds : {pair.low, pair.high}) {
            const double p = odds / (1.0 + odds);
            const double fallen =
                2.0 * (wins * std::log(share / p) + losses * std::log((1.0 - share) / (1.0 - p)));
            EXPECT_NEAR(fallen, kChiSquare95, 1e-6) << wins;
        }
    }
}

TEST(TwoDesigns, FriedmansTestIsTheSignTest) {
    for (const int n : {1, 2, 9, 10, 200, 1000}) {
        const RankSumNull null = rank_sum_null(2, n, false, 1);
        EXPECT_EQ(null.method, Method::exact);
        for (const int wins : {0, n / 3, n / 2}) {
            double p = 0.0;
            for (int k = 0; k <= n; ++k) {
                if (std::abs(2 * k - n) >= std::abs(2 * wins - n)) p += binomial(n, k, 0.5);
            }
            const VoteCounts counts{{wins, n - wins}, {n - wins, wins}};
            EXPECT_NEAR(friedman_p(null, counts), std::min(p, 1.0), 1e-9) << wins << " of " << n;
        }
    }
}

TEST(TwoDesigns, WinsAreBinomial) {
    const BallotLaw law = ballot_law({0.7, 0.3}, false);
    double first = 0.5 * binomial(10, 5, 0.7);
    for (int k = 6; k <= 10; ++k) first += binomial(10, k, 0.7);
    const WinProbabilities wins = win_probabilities(law, 10, 0, 1, 1);
    EXPECT_NEAR(wins.first[0], first, 1e-12);
    EXPECT_NEAR(wins.first[0] + wins.first[1], 1.0, 1e-12);
    EXPECT_NEAR(wins.top_two, 1.0, 1e-12);
}

TEST(TwoDesigns, PowerIsBinomial) {
    // At odds of 3 in ten ballots the ratio passes 3.841 from 8 to 2 on.
    double power = 0.0;
    for (const int wins : {0, 1, 2, 8, 9, 10}) power += binomial(10, wins, 0.75);
    const double drawn = simulated_power(ballot_law({0.75, 0.25}, false), 10, 0, 1, 1, 20000);
    EXPECT_NEAR(drawn, power, 4.0 * std::sqrt(power * (1.0 - power) / 20000));
    // (1.96 + 0.84)^2 over the ratio that one mean ballot has.
    const double each = 2.0 * (0.75 * std::log(1.5) + 0.25 * std::log(0.5));
    EXPECT_EQ(evaluators_for_power(ballot_law({0.75, 0.25}, false), 0, 1),
              std::ceil(7.8489 / each));
    EXPECT_FALSE(evaluators_for_power(ballot_law({0.5, 0.5}, false), 0, 1));
}

TEST(Agreement, KrippendorffsOwnExample) {
    // Four coders, twelve units, some missing: alpha is .849 on an interval scale (Krippendorff,
    // Computing Krippendorff's Alpha-Reliability, 2011).
    const std::vector<std::vector<double>> values = {{1, 1, 1},
                                                     {2, 2, 3, 2},
                                                     {3, 3, 3, 3},
                                                     {3, 3, 3, 3},
                                                     {2, 2, 2, 2},
                                                     {1, 2, 3, 4},
                                                     {4, 4, 4, 4},
                                                     {1, 1, 2, 1},
                                                     {2, 2, 2, 2},
                                                     {5, 5, 5},
                                                     {1, 1},
                                                     {3}};
    EXPECT_NEAR(*krippendorff_alpha(values), 0.849, 5e-4);
    EXPECT_FALSE(krippendorff_alpha({{1}, {2}}));
    EXPECT_FALSE(krippendorff_alpha({{1, 1}, {1, 1}}));
    EXPECT_FALSE(krippendorff_alpha({}));
}

TEST(Agreement, OfRanksWithMissingVotes) {
    // Everyone the same: 1, whoever left out his second best or his ballot.
    EXPECT_NEAR(*krippendorff_alpha(ranks_given({{1, 0, 2}, {1, 0, 2}, {}}, 3)), 1.0, 1e-12);
    const auto ranks = ranks_given({{1, 0}, {1}, {}}, 4);
    EXPECT_EQ(ranks[0], (std::vector<double>{2.0, 3.0}));
    EXPECT_EQ(ranks[1], (std::vector<double>{1.0, 1.0}));
    EXPECT_EQ(ranks[3], (std::vector<double>{3.5, 3.0}));
    // Two who are opposed as far as two can be.
    EXPECT_LT(*krippendorff_alpha(ranks_given({{0, 1, 2}, {2, 1, 0}}, 3)), -0.2);
    // From counts as from ballots.
    const std::vector<Ballot> ballots = {{0, 1, 3}, {0, 2, 3}, {2, 1, 0}};
    EXPECT_NEAR(*krippendorff_alpha(ranks_given(ballots, 4)),
                *krippendorff_alpha(ranks_given(counts_of(ballots, 4, true))),
                1e-12);
}

TEST(Unanimous, EverythingIsAtItsEnd) {
    const VoteCounts counts{{10, 0, 0, 0}, {0, 10, 0, 0}};
    EXPECT_NEAR(*kendall_w(counts), 1.0, 1e-12);
    EXPECT_NEAR(friedman_q(counts), 30.0, 1e-12);
    // All others must agree with the first: in one ballot of twelve each.
    EXPECT_NEAR(friedman_p(rank_sum_null(4, 10, false, 1), counts), std::pow(12.0, -9), 1e-15);
    const VoteCounts full{{5, 0, 0}, {0, 5, 0}, {0, 0, 5}};
    EXPECT_NEAR(*kendall_w(full), 1.0, 1e-12);
}

}  // namespace
}  // namespace livery
