#include "ballot/secrets.h"

#include <map>
#include <set>
#include <string>

#include <gtest/gtest.h>

namespace livery {
namespace {

TEST(Secrets, AreHashedWithSha256) {
    // FIPS 180-2, appendix B.1, and the hash of nothing.
    EXPECT_EQ(hash_of_secret("abc"),
              "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
    EXPECT_EQ(hash_of_secret(""),
              "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
}

TEST(Secrets, AreDifferentEachTime) {
    std::set<std::string> secrets;
    for (int k = 0; k < 1000; ++k) secrets.insert(random_secret());
    EXPECT_EQ(secrets.size(), 1000u);
    for (const auto& secret : secrets) {
        EXPECT_EQ(secret.size(), 32u);
        EXPECT_EQ(secret.find_first_not_of("0123456789abcdef"), std::string::npos);
    }
}

TEST(Secrets, JoinCodesUseEachCharacterAlike) {
    std::map<char, int> counts;
    constexpr int kCodes = 9000;
    for (int k = 0; k < kCodes; ++k) {
        const std::string code = random_join_code();
        ASSERT_EQ(code.size(), 8u);
        EXPECT_EQ(tidy_join_code(code), code);
        for (const char c : code) ++counts[c];
    }
    ASSERT_EQ(counts.size(), 27u);
    // 2667 of each, within six sigma.
    for (const auto& [character, count] : counts) {
        EXPECT_NEAR(count, kCodes * 8 / 27, 6 * 51) << character;
        EXPECT_EQ(std::string("0O1ILAEUY").find(character), std::string::npos);
    }
}

TEST(Secrets, JoinCodesAreTakenAsTheyAreTyped) {
    EXPECT_EQ(tidy_join_code("k7m2-pq34"), "K7M2PQ34");
    EXPECT_EQ(tidy_join_code(" K7M2 PQ34 "), "K7M2PQ34");
    EXPECT_EQ(tidy_join_code(""), "");
}

}  // namespace
}  // namespace livery
