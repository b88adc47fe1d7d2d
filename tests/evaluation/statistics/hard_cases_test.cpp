// Rounds at the edge of what can be: every figure is a number, in its range.

#include <cmath>
#include <numeric>

#include <gtest/gtest.h>

#include "evaluation/statistics/table3.h"
#include "evaluation/statistics/vote_statistics.h"
#include "support/message_of.h"

namespace livery {
namespace {

void expect_probability(double p, const char* name) {
    EXPECT_TRUE(std::isfinite(p)) << name;
    constexpr double rounding = 1e-12;
    EXPECT_GE(p, -rounding) << name;
    EXPECT_LE(p, 1.0 + rounding) << name;
}

void expect_sound(const VoteCounts& counts, const std::vector<Ballot>* ballots = nullptr) {
    SCOPED_TRACE(std::to_string(counts.designs()) + " designs, " +
                 std::to_string(counts.evaluators()) + " evaluators, first " +
                 std::to_string(counts.best[0]) + (counts.has_least() ? ", least" : ""));
    const VoteStatistics found =
        vote_statistics(counts, default_names(counts.designs()), 1, ballots, 100);
    const double designs = counts.designs();
    expect_probability(found.best_votes.asymptotic_p, "best, asymptotic");
    expect_probability(found.best_votes.p, "best");
    expect_probability(found.friedman_asymptotic_p, "Friedman, asymptotic");
    expect_probability(found.friedman_p, "Friedman");
    if (found.kendall_w) expect_probability(*found.kendall_w, "W");
    EXPECT_EQ(found.kendall_w.has_value(), counts.evaluators() > 0);
    EXPECT_LE(found.krippendorff_alpha.value_or(1.0), 1.0 + 1e-12);
    EXPECT_NEAR(std::accumulate(found.rank_sums.begin(), found.rank_sums.end(), 0.0),
                0.5 * counts.evaluators() * designs * (designs + 1.0),
                1e-9);
    EXPECT_NEAR(std::accumulate(found.worths.begin(), found.worths.end(), 0.0), 1.0, 1e-9);
    EXPECT_NEAR(std::accumulate(found.wins.first.begin(), found.wins.first.end(), 0.0), 1.0, 1e-9);
    for (const double worth : found.worths) {
        expect_probability(worth, "worth");
        EXPECT_GT(worth, 0.0);
    }
    expect_probability(found.wins.top_two, "top two");
    for (const PairComparison& pair : found.pairs) {
        expect_probability(pair.p, "pair");
        expect_probability(pair.wald_p, "pair, Wald");
        EXPECT_TRUE(std::isfinite(pair.high) && std::isfinite(pair.wald_high));
        EXPECT_LE(pair.low, pair.odds);
        EXPECT_GE(pair.high, pair.odds);
        EXPECT_GT(pair.low, 0.0);
    }
    for (const auto& power : found.power) expect_probability(power.power, "power");
    for (std::size_t i = 0; i < counts.best.size(); ++i) {
        expect_probability(found.share_best[i].low, "share");
        expect_probability(found.share_named[i].high, "share");
        EXPECT_LE(found.share_best[i].low, found.share_best[i].high);
    }
    expect_probability(found.verdict.win_probability, "win");
    EXPECT_FALSE(found.words.empty());
}

TEST(HardCases, EveryNumberOfDesignsAndAFewEvaluators) {
    for (int designs = 2; designs <= 8; ++designs) {
        for (const int evaluators : {1, 3, 10}) {
            for (const bool has_least : {false, true}) {
                if (has_least && designs < 3) continue;
                Random random(static_cast<std::uint64_t>(designs * 100 + evaluators));
                std::vector<double> worths;
                for (int i = 0; i < designs; ++i) worths.push_back(std::exp(0.9 * i));
                const auto ballots = draw_round(ballot_law(worths, has_least), evaluators, random);
                const VoteCounts counts = counts_of(ballots, designs, has_least);
                if (evaluators == 3) expect_sound(counts);
                expect_sound(counts, &ballots);
            }
        }
    }
}

TEST(HardCases, Unanimous) {
    for (const int evaluators : {1, 2, 40}) {
        const int n = evaluators;
        expect_sound({{n, 0}, {0, n}});
        expect_sound({{n, 0, 0}, {0, n, 0}});
        expect_sound({{n, 0, 0}, {0, n, 0}, {0, 0, n}});
        expect_sound({{0, 0, 0, n}, {n, 0, 0, 0}});
        expect_sound({{0, 0, 0, n, 0}, {n, 0, 0, 0, 0}, {0, n, 0, 0, 0}});
    }
}

TEST(HardCases, NobodyAndEveryoneAlike) {
    expect_sound({{0, 0, 0, 0}, {0, 0, 0, 0}});
    expect_sound({{0, 0, 0, 0}, {0, 0, 0, 0}, {0, 0, 0, 0}});
    expect_sound({{3, 3, 3, 3}, {3, 3, 3, 3}});
    expect_sound({{3, 3, 3, 3}, {3, 3, 3, 3}, {3, 3, 3, 3}});
    expect_sound({{5, 5}, {5, 5}});
    expect_sound({{5, 5, 0, 0}, {5, 5, 0, 0}, {0, 0, 9, 1}});
}

TEST(HardCases, AThousandEvaluators) {
    expect_sound({{999, 1, 0, 0}, {0, 998, 1, 1}});
    expect_sound({{400, 300, 200, 50, 50}, {200, 300, 300, 100, 100}, {100, 100, 100, 350, 350}});
}

TEST(HardCases, TwentySixDesigns) {
    std::vector<int> best(26, 0), second(26, 0);
    best[0] = 7;
    best[25] = 3;
    second[25] = 7;
    second[12] = 3;
    expect_sound({best, second});
}

TEST(HardCases, AnOrderOfDesignsIsNoMatter) {
    const auto straight = vote_statistics(table3(), default_names(4), 1);
    const auto turned =
        vote_statistics({{2, 1, 6, 1}, {5, 2, 3, 0}}, {"(d)", "(c)", "(b)", "(a)"}, 1);
    EXPECT_NEAR(straight.friedman_p, turned.friedman_p, 1e-12);
    EXPECT_NEAR(straight.best_votes.p, turned.best_votes.p, 1e-12);
    EXPECT_NEAR(*straight.krippendorff_alpha, *turned.krippendorff_alpha, 1e-12);
    for (std::size_t i = 0; i < 4; ++i) {
        EXPECT_NEAR(straight.worths[i], turned.worths[3 - i], 1e-9);
        EXPECT_NEAR(straight.wins.first[i], turned.wins.first[3 - i], 1e-9);
    }
    EXPECT_NEAR(straight.wins.top_two, turned.wins.top_two, 1e-9);
    EXPECT_EQ(straight.words, turned.words);
}

TEST(HardCases, CountsThatCannotBeAreRefusedByName) {
    const auto message = [](const VoteCounts& counts) {
        return message_of([&] { check_counts(counts); });
    };
    EXPECT_EQ(message({{1}, {1}}), "best: found 1 design, expected 2 to 26 to choose between");
    EXPECT_EQ(message({{1, 2}, {1, 2, 0}}),
              "second: found 3 counts, expected 2, as many as for best");
    EXPECT_EQ(message({{1, -1, 3}, {1, 1, 1}}), "best: found -1, expected counts of 0 or more");
    EXPECT_EQ(
        message({{1, 2, 3}, {1, 2, 2}}),
        "second: found 5 votes, expected 6, as many as for best: each ballot names one of each");
    EXPECT_EQ(
        message({{5, 1, 0}, {5, 1, 0}}),
        "design 1: found 10 votes, expected at most 6: a ballot names a design once, and there "
        "are no more ballots");
    EXPECT_EQ(message({{1000, 1}, {1, 1000}}),
              "best: found 1001 evaluators, expected at most 1000");
    EXPECT_EQ(message({{2147483647, 2147483647}, {1, 1}}),
              "best: found 4294967294 evaluators, expected at most 1000");
    EXPECT_EQ(message({{1, 1}, {1, 1}, {1, 1}}),
              "least: found 2 designs, expected 3 or more: of two, the second best is the least");
    EXPECT_EQ(message_of([] { vote_statistics(table3(), {"a"}, 1); }),
              "names: found 1, expected 4, one a design");
}

}  // namespace
}  // namespace livery
