// Small rounds of which every set of ballots can be gone through.

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <set>

#include <gtest/gtest.h>

#include "evaluation/statistics/preference_tests.h"
#include "evaluation/statistics/winners.h"

namespace livery {
namespace {

struct Size {
    int designs, evaluators;
    bool has_least;
};
const std::vector<Size> kSizes = {{2, 6, false},
                                  {3, 5, false},
                                  {4, 4, false},
                                  {5, 3, false},
                                  {3, 5, true},
                                  {4, 3, true},
                                  {5, 2, true}};

/// Calls back with each possible round and its probability.
void for_rounds(const BallotLaw& law,
                int evaluators,
                const std::function<void(const std::vector<Ballot>&, double)>& told) {
    std::vector<Ballot> round;
    const std::function<void(double)> more = [&](double probability) {
        if (static_cast<int>(round.size()) == evaluators) {
            told(round, probability);
            return;
        }
        for (std::size_t b = 0; b < law.ballots.size(); ++b) {
            round.push_back(law.ballots[b]);
            more(probability * law.probabilities[b]);
            round.pop_back();
        }
    };
    more(1.0);
}

BallotLaw even_law(const Size& size) {
    return ballot_law(std::vector<double>(static_cast<std::size_t>(size.designs), 1.0),
                      size.has_least);
}

TEST(Enumeration, FriedmansPAndTheRange) {
    for (const Size& size : kSizes) {
        SCOPED_TRACE(std::to_string(size.designs) + " designs, " + std::to_string(size.evaluators));
        std::map<long, double> of_q;  // by Q, in millionths
        std::map<double, double> of_range;
        std::vector<std::pair<VoteCounts, double>> seen;
        for_rounds(even_law(size), size.evaluators, [&](const auto& round, double probability) {
            const VoteCounts counts = counts_of(round, size.designs, size.has_least);
            const double q = friedman_q(counts);
            if (of_q[std::lround(1e6 * q)] == 0.0) seen.emplace_back(counts, q);
            of_q[std::lround(1e6 * q)] += probability;
            const auto sums = rank_sums(counts);
            const auto [low, high] = std::minmax_element(sums.begin(), sums.end());
            of_range[*high - *low] += probability;
        });
        const RankSumNull null = rank_sum_null(size.designs, size.evaluators, size.has_least, 1);
        ASSERT_EQ(null.method, Method::exact);
        for (const auto& [counts, q] : seen) {
            double p = 0.0;
            for (const auto& [millionths, probability] : of_q) {
                if (millionths >= std::lround(1e6 * q)) p += probability;
            }
            EXPECT_NEAR(friedman_p(null, counts), p, 1e-10) << q;
        }
        for (const double level : {0.05, 0.3}) {
            std::optional<double> threshold;
            double sum = 0.0;
            for (auto at = of_range.rbegin(); at != of_range.rend(); ++at) {
                sum += at->second;
                if (sum > level + 1e-9) break;
                threshold = at->first;
            }
            EXPECT_EQ(range_threshold(null, level), threshold);
        }
    }
}

TEST(Enumeration, DrawsComeNearTheExactP) {
    for (const bool has_least : {false, true}) {
        VoteCounts counts{{1, 6, 1, 2}, {0, 3, 2, 5}};
        if (has_least) counts.least = {7, 0, 3, 0};
        const double exact = friedman_p(rank_sum_null(4, 10, has_least, 1), counts);
        const RankSumNull drawn = rank_sum_null(4, 10, has_least, 1, 10);
        EXPECT_EQ(drawn.method, Method::drawn);
        EXPECT_EQ(drawn.cases, 1'000'000);
        EXPECT_NEAR(friedman_p(drawn, counts), exact, 5.0 * std::sqrt(exact * 1e-6));
        EXPECT_EQ(range_threshold(drawn), range_threshold(rank_sum_null(4, 10, has_least, 1)));
        // The same again, and others with another seed.
        EXPECT_EQ(rank_sum_null(4, 10, has_least, 1, 10).spread, drawn.spread);
        EXPECT_NE(rank_sum_null(4, 10, has_least, 2, 10).spread, drawn.spread);
    }
}

TEST(Enumeration, VotesForBestAlone) {
    const std::vector<std::vector<int>> cases = {{2, 2, 2},
                                                 {6, 0, 0},
                                                 {3, 2, 1},
                                                 {5, 0, 1},
                                                 {4, 0},
                                                 {1, 1, 1, 2},
                                                 {0, 5, 0, 0},
                                                 {1, 0, 0, 0, 0}};
    for (const auto& best : cases) {
        int evaluators = 0;
        long squares = 0;
        for (const int count : best) {
            evaluators += count;
            squares += count * count;
        }
        double as_large = 0.0, all = 0.0;
        std::vector<int> counts(best.size());
        const std::function<void(int)> vote = [&](int voter) {
            if (voter == evaluators) {
                long sum = 0;
                for (const int count : counts) sum += count * count;
                as_large += sum >= squares ? 1.0 : 0.0;
                all += 1.0;
                return;
            }
            for (int& count : counts) {
                ++count;
                vote(voter + 1);
                --count;
            }
        };
        vote(0);
        EXPECT_NEAR(best_votes_test(best, 1).p, as_large / all, 1e-12) << evaluators;
        const BestVotesTest drawn = best_votes_test(best, 1, 0);
        EXPECT_EQ(drawn.method, Method::drawn);
        EXPECT_NEAR(drawn.p, as_large / all, 0.003);
    }
}

TEST(Enumeration, WhoWins) {
    for (const Size& size : kSizes) {
        SCOPED_TRACE(std::to_string(size.designs) + " designs, " + std::to_string(size.evaluators));
        std::vector<double> worths;
        for (int i = 0; i < size.designs; ++i) worths.push_back(1.0 + i * i);
        const BallotLaw law = ballot_law(worths, size.has_least);
        std::vector<double> first(worths.size(), 0.0);
        double all = 0.0, top_two = 0.0;
        for_rounds(law, size.evaluators, [&](const auto& round, double probability) {
            all += probability;
            const auto sums = rank_sums(counts_of(round, size.designs, size.has_least));
            auto sorted = sums;
            std::sort(sorted.begin(), sorted.end());
            const auto ties = std::count(sums.begin(), sums.end(), sorted[0]);
            for (std::size_t i = 0; i < sums.size(); ++i) {
                if (sums[i] == sorted[0]) first[i] += probability / static_cast<double>(ties);
            }
            const auto reach = static_cast<double>(
                std::count_if(sums.begin(), sums.end(), [&](double s) { return s <= sorted[1]; }));
            if (sums[0] <= sorted[1] && sums[1] <= sorted[1]) {
                top_two += probability * 2.0 / (reach * (reach - 1.0));
            }
        });
        EXPECT_NEAR(all, 1.0, 1e-12);
        const WinProbabilities wins = win_probabilities(law, size.evaluators, 0, 1, 1);
        const WinProbabilities drawn = win_probabilities(law, size.evaluators, 0, 1, 1, 1);
        EXPECT_EQ(wins.method, Method::exact);
        EXPECT_EQ(drawn.method, Method::drawn);
        for (std::size_t i = 0; i < first.size(); ++i) {
            EXPECT_NEAR(wins.first[i], first[i], 1e-12);
            EXPECT_NEAR(drawn.first[i], first[i], 0.008);
        }
        EXPECT_NEAR(wins.top_two, top_two, 1e-12);
        EXPECT_NEAR(drawn.top_two, top_two, 0.008);
    }
}

TEST(Enumeration, CountsThatSomeBallotsHaveAndNoOthers) {
    for (const Size& size :
         std::vector<Size>{{2, 3, false}, {3, 2, false}, {3, 2, true}, {4, 2, true}}) {
        std::set<std::vector<int>> possible;
        const auto key = [](const VoteCounts& counts) {
            std::vector<int> all = counts.best;
            all.insert(all.end(), counts.second.begin(), counts.second.end());
            all.insert(all.end(), counts.least.begin(), counts.least.end());
            return all;
        };
        for_rounds(even_law(size), size.evaluators, [&](const auto& round, double) {
            possible.insert(key(counts_of(round, size.designs, size.has_least)));
        });
        // Every list of numbers from 0 to one more than there are evaluators.
        const auto designs = static_cast<std::size_t>(size.designs);
        std::vector<int> numbers(designs * (size.has_least ? 3 : 2), 0);
        std::size_t accepted = 0, tried = 0;
        while (true) {
            const auto at = [&](std::size_t list) {
                const auto begin = numbers.begin() + static_cast<std::ptrdiff_t>(list * designs);
                return std::vector<int>(begin, begin + static_cast<std::ptrdiff_t>(designs));
            };
            const VoteCounts counts{at(0), at(1), size.has_least ? at(2) : std::vector<int>{}};
            if (counts.evaluators() == size.evaluators) {
                ++tried;
                bool fits = true;
                try {
                    check_counts(counts);
                } catch (const std::invalid_argument&) {
                    fits = false;
                }
                accepted += fits ? 1 : 0;
                EXPECT_EQ(fits, possible.contains(key(counts)));
            }
            std::size_t digit = 0;
            while (digit < numbers.size() && numbers[digit] == size.evaluators)
                numbers[digit++] = 0;
            if (digit == numbers.size()) break;
            ++numbers[digit];
        }
        EXPECT_EQ(accepted, possible.size());
        EXPECT_LT(accepted, tried);
    }
}

}  // namespace
}  // namespace livery
