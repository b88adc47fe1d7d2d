#include <algorithm>
#include <set>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

#include "evaluation/presentation_order.h"

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

}  // namespace
}  // namespace livery
