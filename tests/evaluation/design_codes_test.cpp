#include "evaluation/design_codes.h"

#include <set>
#include <stdexcept>

#include <gtest/gtest.h>

namespace livery {
namespace {

TEST(DesignCodes, AreDifferentThreeDigitNumbersAndTheSameForASeed) {
    for (const int seed : {1, 2, 77, -5}) {
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
    const auto all = draw_codes(900, 3, 1);
    EXPECT_EQ(std::set<int>(all.begin(), all.end()).size(), 900u);
    EXPECT_TRUE(draw_codes(0, 1, 1).empty());
    EXPECT_THROW(draw_codes(901, 1, 1), std::invalid_argument);
}

TEST(DesignCodes, SayNothingOfTheirPlace) {
    // The first of four is the smallest in a quarter of the draws: 4000 of them, within 4 sigma.
    int smallest = 0;
    for (int seed = 0; seed < 4000; ++seed) {
        const auto codes = draw_codes(4, seed, 1);
        if (codes[0] < codes[1] && codes[0] < codes[2] && codes[0] < codes[3]) ++smallest;
    }
    EXPECT_NEAR(smallest, 1000, 4 * 27.4);
}

}  // namespace
}  // namespace livery
