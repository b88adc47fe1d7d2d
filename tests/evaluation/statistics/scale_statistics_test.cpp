// What answers on scales say, against worked examples.
#include "evaluation/statistics/scale_statistics.h"

#include <gtest/gtest.h>

#include "core/random.h"

namespace livery {
namespace {

const std::vector<SemanticScale> kScales = {{"cheap", "precious"}, {"cold", "warm"}};

/// One scale, an evaluator a row, a design a column.
std::vector<ScaleAnswers> on_one_scale(const std::vector<std::vector<int>>& rows) {
    std::vector<ScaleAnswers> answers;
    for (const auto& row : rows) {
        ScaleAnswers& own = answers.emplace_back();
        for (const int step : row) own.push_back({step});
    }
    return answers;
}

ScaleStatistics said_of(const std::vector<std::vector<int>>& rows,
                        const std::vector<std::string>& names) {
    return scale_statistics(on_one_scale(rows), {kScales[0]}, names, 1);
}

TEST(Scales, HolmStepsDown) {
    // Holm's own way with four p: 4 x .005, 3 x .01, 2 x .03, .04 raised to the one before.
    const auto adjusted = holm_adjusted({0.01, 0.04, 0.03, 0.005});
    EXPECT_NEAR(adjusted[0], 0.03, 1e-15);
    EXPECT_NEAR(adjusted[1], 0.06, 1e-15);
    EXPECT_NEAR(adjusted[2], 0.06, 1e-15);
    EXPECT_NEAR(adjusted[3], 0.02, 1e-15);
    EXPECT_EQ(holm_adjusted({0.7}), (std::vector<double>{0.7}));
    EXPECT_EQ(holm_adjusted({0.7, 0.9}), (std::vector<double>{1.0, 1.0}));
    EXPECT_TRUE(holm_adjusted({}).empty());
}

TEST(Scales, PointsOfStudentsT) {
    EXPECT_NEAR(student_975(1), 12.706204736432095, 1e-9);
    EXPECT_NEAR(student_975(4), 2.7764451051977987, 1e-10);
    EXPECT_NEAR(student_975(9), 2.2621571628540993, 1e-10);
    EXPECT_NEAR(student_975(1'000'000), kNormal975, 1e-5);
}

TEST(Scales, FriedmanAgainstWorkedExamples) {
    // Without ties, all of four alike: Q = n (k - 1), and 1 in 6^3 by chance.
    const auto alike = said_of({{1, 4, 7}, {2, 3, 5}, {1, 2, 3}, {3, 5, 6}}, {"a", "b", "c"});
    EXPECT_NEAR(alike.scales[0].friedman_q, 8.0, 1e-12);
    EXPECT_EQ(alike.scales[0].complete, 4);
    // Four standard errors of 9999 draws of 1/216
    EXPECT_NEAR(alike.scales[0].friedman_p, 1.0 / 216.0, 4.0 * 0.00068);
    // With ties, by hand: ranks 1 2.5 2.5 / 1 2 3 / 1.5 1.5 3; sums 3.5 6 8.5; Q = 2 x 12.5 / 5
    const auto tied = said_of({{1, 5, 5}, {2, 3, 7}, {4, 4, 6}}, {"a", "b", "c"});
    EXPECT_NEAR(tied.scales[0].friedman_q, 5.0, 1e-12);
}

TEST(Scales, OnlyWhoPlacedEveryLookIsTestedAndAllAreInTheMeans) {
    const auto found = said_of({{1, 7}, {2, 6}, {3, 0}, {0, 0}}, {"a", "b"});
    EXPECT_EQ(found.evaluators, 3);
    EXPECT_EQ(found.scales[0].complete, 2);
    EXPECT_EQ(found.scales[0].looks[0].answers, 3);
    EXPECT_NEAR(found.scales[0].looks[0].mean, 2.0, 1e-15);
    EXPECT_EQ(found.scales[0].looks[0].interval.low, 1.0) << "of three nothing is known";
    EXPECT_EQ(found.scales[0].looks[0].interval.high, 7.0);
    const auto none = said_of({{1, 0}, {0, 6}}, {"a", "b"});
    EXPECT_EQ(none.scales[0].words,
              "cheap – precious: nobody placed every look on it, so nothing is tested");
    const auto same = said_of({{4, 4}, {4, 4}, {4, 4}}, {"a", "b"});
    EXPECT_EQ(same.scales[0].friedman_q, 0.0);
    EXPECT_EQ(same.scales[0].friedman_p, 1.0);
    EXPECT_TRUE(scale_statistics({}, {}, {"a"}, 1).scales.empty());
    EXPECT_THROW(said_of({{1, 8}}, {"a", "b"}), std::invalid_argument);
    EXPECT_THROW(said_of({{1}}, {"a", "b"}), std::invalid_argument);
}

TEST(Scales, WordsNeverSayMore) {
    std::vector<std::vector<int>> rows(8, {2, 6, 4});
    EXPECT_EQ(
        said_of(rows, {"red", "silver", "sand"}).scales[0].words,
        "cheap – precious: the looks differ (8 evaluators, p = 0.0001 after Holm); red has the "
        "lowest mean, 2.0, and silver the highest, 6.0. Which of them differ is not tested");
    rows = {{2, 6}, {6, 2}, {3, 4}, {4, 3}};
    EXPECT_EQ(said_of(rows, {"red", "silver"}).scales[0].words,
              "cheap – precious: the looks are not shown to differ (4 evaluators placed all of "
              "them, p = 1 after Holm); it does not say that they are alike");
}

TEST(Scales, TheSeedAloneDecidesTheDraws) {
    Random random(5);
    std::vector<std::vector<int>> rows;
    for (int k = 0; k < 12; ++k) {
        auto& row = rows.emplace_back();
        for (int look = 0; look < 4; ++look) row.push_back(1 + static_cast<int>(random.below(7)));
    }
    const auto answers = on_one_scale(rows);
    const std::vector<std::string> names = {"a", "b", "c", "d"};
    const auto one = scale_statistics(answers, {kScales[0]}, names, 1);
    const auto again = scale_statistics(answers, {kScales[0]}, names, 1);
    EXPECT_EQ(one.scales[0].friedman_p, again.scales[0].friedman_p);
    for (std::size_t k = 0; k < names.size(); ++k) {
        const LookOnScale& look = one.scales[0].looks[k];
        EXPECT_EQ(look.interval.low, again.scales[0].looks[k].interval.low);
        EXPECT_LT(look.interval.low, look.mean);
        EXPECT_GT(look.interval.high, look.mean);
    }
}

}  // namespace
}  // namespace livery
