// What a duel says, against closed forms.
#include "evaluation/statistics/duel_statistics.h"

#include <cmath>

#include <gtest/gtest.h>

namespace livery {
namespace {

/// `count` evaluators who answered this.
void add(std::vector<DuelAnswers>& answers, int count, const DuelAnswers& own) {
    answers.insert(answers.end(), static_cast<std::size_t>(count), own);
}

std::string words(const std::vector<DuelAnswers>& answers, int shown = 3) {
    return words_of(duel_statistics(answers, 3), {"(b)", "(d)"}, shown);
}

TEST(Duel, TailsOfTheBinomialAreExact) {
    EXPECT_NEAR(binomial_tail(9, 10, 0.5), 11.0 / 1024.0, 1e-15);
    EXPECT_NEAR(binomial_tail(10, 10, 0.5), 1.0 / 1024.0, 1e-16);
    EXPECT_EQ(binomial_tail(0, 10, 0.5), 1.0);
    EXPECT_EQ(binomial_tail(11, 10, 0.5), 0.0);
    EXPECT_EQ(binomial_tail(1, 5, 0.0), 0.0);
    EXPECT_EQ(binomial_tail(5, 5, 1.0), 1.0);
    // Of 4 with a chance of a quarter: 3 x 4 / 256 + 1 / 256
    EXPECT_NEAR(binomial_tail(3, 4, 0.25), 13.0 / 256.0, 1e-15);
    for (const int of : {1, 7, 40, 1000}) {
        EXPECT_NEAR(binomial_tail(1, of, 0.25), 1.0 - std::pow(0.75, of), 1e-11) << of;
    }
}

TEST(Duel, CountsEachEvaluatorOnceByTheMajority) {
    std::vector<DuelAnswers> answers;
    add(answers, 6, {0, 0, 0});
    add(answers, 3, {0, 1, 0});
    add(answers, 1, {1, 0, 1});
    const DuelStatistics found = duel_statistics(answers, 3);
    EXPECT_EQ(found.majorities, (std::array<int, 2>{9, 1}));
    EXPECT_NEAR(found.sign_p, 22.0 / 1024.0, 1e-14);
    EXPECT_EQ(found.ahead, 0);
    EXPECT_EQ(found.complete, 10);
    EXPECT_EQ(found.consistent, 6);
    EXPECT_NEAR(found.consistency_p, binomial_tail(6, 10, 0.25), 1e-15);
    EXPECT_EQ(found.incomplete, 0);
    EXPECT_EQ(found.kind, DuelVerdictKind::preferred);
    const Interval wilson = wilson_interval(9, 10);
    EXPECT_EQ(found.share.low, wilson.low);
    EXPECT_EQ(found.share.high, wilson.high);
    EXPECT_EQ(words(answers),
              "(b) is preferred to (d) in the duel: 9 of 10 evaluators chose it most often (sign "
              "test, p = 0.021; 95% interval of their share 60% to 98%). Of 10 who answered every "
              "repeat 6 gave the same answer each time; guessing gives 25% (p = 0.02): that is "
              "more than guessing explains");
    // The other way round is the other look's.
    for (DuelAnswers& own : answers) {
        for (int& answer : own) answer = 1 - answer;
    }
    EXPECT_EQ(words(answers).substr(0, 24), "(d) is preferred to (b) ");
}

TEST(Duel, SaysNoMoreThanTheAnswersDo) {
    EXPECT_EQ(words({}), "nobody has answered in the duel of (b) and (d)");
    EXPECT_EQ(words({{-1, -1, -1}}), "nobody has answered in the duel of (b) and (d)");
    std::vector<DuelAnswers> answers;
    add(answers, 5, {1, 1, 1});
    EXPECT_EQ(duel_statistics(answers, 3).kind, DuelVerdictKind::too_few)
        << "1 in 16 by chance, though all agree";
    EXPECT_EQ(
        words(answers).substr(0, 86),
        "5 evaluators with a majority are too few to show a preference between (b) and (d) in a");
    add(answers, 1, {1, 1, 1});
    EXPECT_EQ(duel_statistics(answers, 3).kind, DuelVerdictKind::preferred) << "1 in 32";
    answers.clear();
    add(answers, 6, {0, 1, 0});
    add(answers, 4, {1, 0, 1});
    EXPECT_EQ(words(answers),
              "the duel shows no preference between (b) and (d): 6 of 10 evaluators chose (b) most "
              "often (p = 0.75). It does not say that they are liked alike: 31% to 83% may prefer "
              "(b). Of 10 who answered every repeat 0 gave the same answer each time; guessing "
              "gives 25% (p = 1): that is not shown to be more than guessing");
}

TEST(Duel, MissingAnswersAreCountedWhereTheyChangeNothingAndStated) {
    std::vector<DuelAnswers> answers;
    add(answers, 7, {0, 0, 1});
    add(answers, 2, {0, -1, 0});   // whatever the third would have been
    add(answers, 1, {-1, 0, 1});   // no majority
    add(answers, 1, {-1, -1, 1});  // one answer is none of three
    add(answers, 4, {-1, -1, -1});
    const DuelStatistics found = duel_statistics(answers, 3);
    EXPECT_EQ(found.evaluators, 11);
    EXPECT_EQ(found.majorities, (std::array<int, 2>{9, 0}));
    EXPECT_EQ(found.incomplete, 4);
    EXPECT_EQ(found.incomplete_counted, 2);
    EXPECT_EQ(found.complete, 7);
    const std::string text = words(answers, 2);
    EXPECT_NE(text.find("4 evaluators did not answer every repeat: 2 had a majority all the same, "
                        "2 are left out."),
              std::string::npos)
        << text;
    EXPECT_NE(text.find("broken off after 2 of 3 repeats"), std::string::npos) << text;
    for (const auto& wrong : std::vector<std::vector<DuelAnswers>>{{{0, 1}}, {{0, 1, 2}}}) {
        EXPECT_THROW(duel_statistics(wrong, 3), std::invalid_argument);
    }
    EXPECT_THROW(duel_statistics({}, 1), std::invalid_argument);
}

}  // namespace
}  // namespace livery
