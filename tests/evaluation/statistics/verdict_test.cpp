// What is said in words, for the rounds that people have.

#include <gtest/gtest.h>

#include "evaluation/statistics/table3.h"
#include "evaluation/statistics/vote_statistics.h"

namespace livery {
namespace {

VoteStatistics said_of(const VoteCounts& counts, const std::vector<Ballot>* ballots = nullptr) {
    return vote_statistics(counts, default_names(counts.designs()), 1, ballots, 100);
}

void expect_words(const VoteCounts& counts, VerdictKind kind, const std::string& beginning) {
    const VoteStatistics found = said_of(counts);
    EXPECT_EQ(found.verdict.kind, kind) << found.words;
    EXPECT_EQ(found.words.substr(0, beginning.size()), beginning);
}

TEST(Verdict, OfFewOrNone) {
    expect_words({{0, 0, 0}, {0, 0, 0}}, VerdictKind::nobody, "nobody has voted");
    expect_words({{0, 1, 0}, {1, 0, 0}},
                 VerdictKind::one_evaluator,
                 "one evaluator prefers (b) to (a): one ballot tells nothing of others");
    expect_words({{2, 0, 0, 0}, {0, 2, 0, 0}},
                 VerdictKind::no_preference,
                 "two evaluators are too few to show a preference among four designs");
    expect_words({{5, 0}, {0, 5}},
                 VerdictKind::no_preference,
                 "five evaluators are too few to show a preference among two designs");
}

TEST(Verdict, WithoutAPreference) {
    expect_words(
        {{3, 3, 2, 2}, {3, 2, 3, 2}},
        VerdictKind::no_preference,
        "these ten show no preference: ballots as far from even come about in 92% of rounds");
    expect_words({{3, 3, 3, 3}, {3, 3, 3, 3}},
                 VerdictKind::no_preference,
                 "these twelve show no preference: ballots as far from even come about in all of");
    // Eight of ten is not enough for a sign test: p = .109.
    expect_words({{8, 2}, {2, 8}}, VerdictKind::no_preference, "these ten show no preference");
}

TEST(Verdict, OfTwoThatTie) {
    expect_words({{5, 5, 0, 0}, {5, 5, 0, 0}},
                 VerdictKind::cannot_tell,
                 "these ten cannot tell (a) from (b), which have the same votes");
    expect_words({{0, 5, 4, 1}, {0, 4, 5, 1}},
                 VerdictKind::cannot_tell,
                 "these ten cannot tell (b) from (c)");
}

TEST(Verdict, OfAWinner) {
    expect_words(
        {{10, 0, 0, 0}, {0, 10, 0, 0}}, VerdictKind::clear_winner, "(a) is the clear winner");
    expect_words({{10, 0}, {0, 10}}, VerdictKind::clear_winner, "(a) is the clear winner");
    expect_words(
        {{20, 180, 30, 20}, {80, 30, 70, 70}}, VerdictKind::clear_winner, "(b) is the clear");
}

TEST(Verdict, NeedsMoreThanTheIntervalOfTheLikelihood) {
    // 8 to 2 among two that everybody prefers to the others: by chi-square p is just below .05, by
    // the law of such rounds it is .11.
    const VoteCounts counts{{16, 4, 0, 0}, {4, 15, 1, 0}};
    const VoteStatistics twenty = said_of(counts);
    EXPECT_EQ(twenty.verdict.kind, VerdictKind::clear_winner) << twenty.words;
    const VoteStatistics ten = said_of({{8, 2, 0, 0}, {1, 7, 1, 1}});
    EXPECT_EQ(ten.verdict.kind, VerdictKind::leading) << ten.words;
}

TEST(PredictedWins, CountWhatTheBallotsLeaveOpen) {
    const VoteStatistics found = said_of(table3());
    double sum = 0.0;
    for (const double first : found.predicted.first) sum += first;
    EXPECT_NEAR(sum, 1.0, 1e-9);
    EXPECT_LT(found.predicted.first[1], found.wins.first[1] - 0.05) << "the fitted worths for true";
    EXPECT_EQ(found.predicted.first, said_of(table3()).predicted.first) << "the seed decides";
    // Nobody can be sure of ten who agree.
    const VoteStatistics all = said_of({{10, 0, 0}, {0, 10, 0}});
    EXPECT_GT(all.predicted.first[0], 0.95);
    EXPECT_LT(all.predicted.first[0], 1.0);
    for (const double first : said_of({{0, 0, 0}, {0, 0, 0}}).predicted.first)
        EXPECT_NEAR(first, 1.0 / 3.0, 1e-12);
}

TEST(Verdict, KnowsSingleBallots) {
    std::vector<Ballot> ballots;
    for (int k = 0; k < 5; ++k) ballots.push_back({1, 3});
    ballots.insert(ballots.end(), {{1, 2}, {0, 1}, {2, 1}, {3, 1}, {3, 2}});
    ASSERT_EQ(counts_of(ballots, 4, false).best, table3().best);
    ASSERT_EQ(counts_of(ballots, 4, false).second, table3().second);
    const VoteStatistics found = said_of(table3(), &ballots);
    ASSERT_TRUE(found.resampled);
    EXPECT_EQ(found.resampled->cases, 10'000);
    EXPECT_EQ(found.verdict.win_probability, found.predicted.first[1]);
    EXPECT_EQ(found.verdict.kind, VerdictKind::leading);
}

}  // namespace
}  // namespace livery
