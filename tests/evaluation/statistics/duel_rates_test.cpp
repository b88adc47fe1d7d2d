// How often a duel's verdict is wrong, over drawn duels in which nobody is preferred.

#include <cmath>
#include <iostream>

#include <gtest/gtest.h>

#include "core/random.h"
#include "evaluation/statistics/duel_statistics.h"

namespace livery {
namespace {

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

}  // namespace
}  // namespace livery
