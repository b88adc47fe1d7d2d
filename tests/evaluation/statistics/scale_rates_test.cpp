// How often scales are called different where no look differs, and how often intervals hold.

#include <algorithm>
#include <cmath>
#include <iostream>

#include <gtest/gtest.h>

#include "core/random.h"
#include "evaluation/statistics/scale_statistics.h"

namespace livery {
namespace {

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
