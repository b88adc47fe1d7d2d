#include "evaluation/presentation_order.h"

#include <algorithm>
#include <map>
#include <set>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

#include "support/message_of.h"

namespace livery {
namespace {

TEST(DesignCodes, AreDifferentThreeDigitNumbersAndTheSameForASeed) {
    for (const std::uint64_t seed : {1u, 2u, 77u}) {
        const auto codes = draw_codes(8, seed, 3);
        EXPECT_EQ(codes, draw_codes(8, seed, 3)) << seed;
        EXPECT_EQ(std::set<int>(codes.begin(), codes.end()).size(), 8u);
        for (const int code : codes) {
            EXPECT_GE(code, 100);
            EXPECT_LE(code, 999);
        }
    }
    EXPECT_NE(draw_codes(8, 1, 3), draw_codes(8, 2, 3));
    EXPECT_NE(draw_codes(8, 1, 3), draw_codes(8, 1, 4)) << "another round";
    const auto all = draw_codes(400, 3, 1);
    EXPECT_EQ(std::set<int>(all.begin(), all.end()).size(), 400u);
    EXPECT_TRUE(draw_codes(0, 1, 1).empty());
    EXPECT_THROW(draw_codes(401, 1, 1), std::invalid_argument);
}

TEST(DesignCodes, SayNothingOfTheirPlace) {
    // The first of four is the smallest in a quarter of the draws: 4000 of them, within 4 sigma.
    int smallest = 0;
    for (std::uint64_t seed = 0; seed < 4000; ++seed) {
        const auto codes = draw_codes(4, seed, 1);
        if (codes[0] < codes[1] && codes[0] < codes[2] && codes[0] < codes[3]) ++smallest;
    }
    EXPECT_NEAR(smallest, 1000, 4 * 27.4);
}

TEST(DesignCodes, AreNotMistakenForOneAnother) {
    std::set<std::string> seen;
    for (std::uint64_t seed = 0; seed < 300; ++seed) {
        const int designs = seed % 3 == 0 ? 26 : 4;
        std::vector<std::string> codes;
        for (const int code : draw_codes(designs, seed, 1)) codes.push_back(std::to_string(code));
        ASSERT_EQ(codes.size(), static_cast<std::size_t>(designs));
        for (std::size_t i = 0; i < codes.size(); ++i) {
            const std::string& code = codes[i];
            seen.insert(code);
            ASSERT_EQ(code.size(), 3u);
            EXPECT_EQ(code.find('0'), std::string::npos) << code;
            EXPECT_EQ(std::set<char>(code.begin(), code.end()).size(), 3u) << code;
            EXPECT_NE(code.find_first_not_of("1689"), std::string::npos) << code;
            for (std::size_t j = 0; j < i; ++j) {
                std::string one = code, other = codes[j];
                int same = 0;
                for (std::size_t k = 0; k < 3; ++k) same += one[k] == other[k] ? 1 : 0;
                EXPECT_LT(same, 2) << one << " and " << other;
                std::sort(one.begin(), one.end());
                std::sort(other.begin(), other.end());
                EXPECT_NE(one, other);
            }
        }
    }
    for (const char* run : {"123", "321", "789", "987"}) EXPECT_FALSE(seen.contains(run));
    // Of 504 with different digits all come but 14 runs and 24 that turn.
    EXPECT_EQ(seen.size(), 466u);
}

TEST(PresentationOrder, OfFourIsThePublishedSquare) {
    EXPECT_EQ(
        williams_rows(4),
        (std::vector<std::vector<int>>{{0, 1, 3, 2}, {1, 2, 0, 3}, {2, 3, 1, 0}, {3, 0, 2, 1}}));
}

TEST(PresentationOrder, EveryDesignInEveryPlaceAndAfterEveryOther) {
    for (int designs = 2; designs <= 26; ++designs) {
        const auto rows = williams_rows(designs);
        const int times = designs % 2 == 0 ? 1 : 2;
        EXPECT_EQ(rows.size(), static_cast<std::size_t>(designs * times));
        std::map<std::pair<std::size_t, int>, int> places;
        std::map<std::pair<int, int>, int> follow;
        for (const auto& row : rows) {
            EXPECT_EQ(std::set<int>(row.begin(), row.end()).size(),
                      static_cast<std::size_t>(designs));
            for (std::size_t k = 0; k < row.size(); ++k) {
                ++places[{k, row[k]}];
                if (k > 0) ++follow[{row[k - 1], row[k]}];
            }
        }
        EXPECT_EQ(places.size(), static_cast<std::size_t>(designs * designs));
        EXPECT_EQ(follow.size(), static_cast<std::size_t>(designs * (designs - 1)));
        for (const auto& [where, count] : places) EXPECT_EQ(count, times);
        for (const auto& [pair, count] : follow) EXPECT_EQ(count, times);
    }
}

TEST(PresentationOrder, IsTheSameForASeedOnEveryMachine) {
    const auto order = presentation_order(4, 10, 3, 7);
    EXPECT_EQ(order.codes, presentation_order(4, 10, 3, 7).codes);
    EXPECT_NE(order.codes, presentation_order(4, 10, 3, 8).codes);
    // As they came when this was written.
    EXPECT_EQ(order.codes, (std::vector<std::string>{"587", "738", "536", "651"}));
    std::vector<int> rows;
    for (const Wave& wave : order.waves) rows.push_back(wave.row);
    EXPECT_EQ(rows, (std::vector<int>{3, 1, 0, 2}));
}

TEST(PresentationOrder, WavesHoldEveryoneAndUseEveryRowBeforeOneTwice) {
    for (const int designs : {2, 3, 4, 5, 8}) {
        for (const int evaluators : {0, 1, 2, 7, 10, 24, 1000}) {
            for (const int size : {1, 2, 3, 50}) {
                const auto order = presentation_order(designs, evaluators, size, 3);
                const auto rows = static_cast<int>(order.rows.size());
                std::map<int, int> used;
                int seated = 0, least = 1000, most = 0;
                for (const Wave& wave : order.waves) {
                    ++used[wave.row];
                    seated += wave.evaluators;
                    least = std::min(least, wave.evaluators);
                    most = std::max(most, wave.evaluators);
                    EXPECT_EQ(wave.designs, order.rows[static_cast<std::size_t>(wave.row)]);
                    for (std::size_t k = 0; k < wave.designs.size(); ++k) {
                        EXPECT_EQ(wave.codes[k],
                                  order.codes[static_cast<std::size_t>(wave.designs[k])]);
                    }
                }
                EXPECT_EQ(seated, evaluators);
                EXPECT_LE(most, size);
                EXPECT_LE(most - least, 1);
                int fewest = used.size() < order.rows.size() ? 0 : 1000, mostly = 0;
                for (const auto& [row, count] : used) {
                    fewest = std::min(fewest, count);
                    mostly = std::max(mostly, count);
                }
                EXPECT_LE(mostly - fewest, 1);
                EXPECT_EQ(order.balanced, mostly == fewest);
                if (evaluators == 0) {
                    EXPECT_EQ(order.waves.size(), static_cast<std::size_t>(rows));
                }
            }
        }
    }
}

TEST(PresentationOrder, RefusesWhatCannotBe) {
    EXPECT_EQ(message_of([] { williams_rows(1); }), "designs: found 1, expected 2 to 26");
    EXPECT_EQ(message_of([] { presentation_order(4, -1, 3, 1); }),
              "evaluators: found -1, expected 0 to 1000");
    EXPECT_EQ(message_of([] { presentation_order(4, 5, 0, 1); }),
              "wave: found 0, expected 1 to 1000");
}

}  // namespace
}  // namespace livery
