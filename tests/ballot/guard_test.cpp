// Who may ask, secrets, and how often a seat may change what it said.
#include <map>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "ballot/ballot_guard.h"

namespace livery {
namespace {

const ServerNames kNames{false, {"192.168.0.7:8470", "livery.local:8470"}};
const std::string kSecret = "0123456789abcdef0123456789abcdef";

TEST(BallotGuard, KnowsItsOwnHosts) {
    const auto ours = [](const std::string& host) {
        BallotRequest request;
        request.host = host;
        return host_is_ours(request, kNames);
    };
    EXPECT_TRUE(ours("192.168.0.7:8470"));
    EXPECT_TRUE(ours("Livery.LOCAL:8470"));
    for (const char* host : {"",
                             "192.168.0.7",
                             "192.168.0.7:80",
                             "192.168.0.7:8470.evil.example",
                             "evil.example:8470",
                             "192.168.0.7:8470@evil.example",
                             " 192.168.0.7:8470",
                             "localhost:8470",
                             "[::1]:8470"}) {
        EXPECT_FALSE(ours(host)) << host;
    }
}

TEST(BallotGuard, ChangesComeFromItsOwnPage) {
    const auto ours = [](const std::string& origin, const std::string& site, bool tls = false) {
        BallotRequest request;
        request.host = "192.168.0.7:8470";
        request.origin = origin;
        request.fetch_site = site;
        return origin_is_ours(request, ServerNames{tls, kNames.hosts});
    };
    EXPECT_TRUE(ours("http://192.168.0.7:8470", ""));
    EXPECT_TRUE(ours("http://192.168.0.7:8470", "same-origin"));
    EXPECT_TRUE(ours("https://192.168.0.7:8470", "same-origin", true));
    EXPECT_FALSE(ours("http://192.168.0.7:8470", "same-origin", true)) << "another scheme";
    EXPECT_FALSE(ours("https://192.168.0.7:8470", ""));
    for (const char* origin : {"",
                               "null",
                               "http://evil.example",
                               "http://192.168.0.7",
                               "http://192.168.0.7:8470/",
                               "http://192.168.0.7:8470.evil.example",
                               "http://livery.local:8470"}) {
        EXPECT_FALSE(ours(origin, "")) << origin;
    }
    for (const char* site : {"cross-site", "same-site", "none", "SAME-ORIGIN"}) {
        EXPECT_FALSE(ours("http://192.168.0.7:8470", site)) << site;
    }
}

TEST(BallotGuard, FindsOneSeatAmongCookies) {
    EXPECT_EQ(seat_secret("livery-seat=" + kSecret), kSecret);
    EXPECT_EQ(seat_secret("a=b; livery-seat=" + kSecret + "; c"), kSecret);
    EXPECT_EQ(seat_secret(" livery-seat = " + kSecret + " "), kSecret);
    for (const std::string& cookies :
         std::vector<std::string>{std::string(),
                                  std::string("livery-seat="),
                                  "livery-seat=" + kSecret.substr(1),
                                  "livery-seat=" + kSecret + "0",
                                  "livery-seat=\"" + kSecret + "\"",
                                  "livery-seat=0123456789ABCDEF0123456789ABCDEF",
                                  "xlivery-seat=" + kSecret,
                                  "livery-seat=' OR ''='0000000000000000000",
                                  // Two of them: one was put there by somebody else.
                                  "livery-seat=" + kSecret + "; livery-seat=" + kSecret,
                                  std::string(";;;=;=;")}) {
        EXPECT_FALSE(seat_secret(cookies)) << cookies;
    }
}

TEST(BallotGuard, HandsOutACookieThatStaysHere) {
    EXPECT_EQ(seat_cookie(kSecret, false),
              "livery-seat=" + kSecret + "; Path=/; Max-Age=43200; HttpOnly; SameSite=Strict");
    EXPECT_TRUE(seat_cookie(kSecret, true).ends_with("; Secure"));
    EXPECT_EQ(seat_secret(seat_cookie(kSecret, true)), kSecret);
}

TEST(BallotGuard, ComparesSecrets) {
    EXPECT_TRUE(same_secret(kSecret, kSecret));
    EXPECT_FALSE(same_secret(kSecret, "1" + kSecret.substr(1)));
    EXPECT_FALSE(same_secret(kSecret.substr(1), kSecret));
    EXPECT_FALSE(same_secret("", kSecret));
    EXPECT_FALSE(same_secret(std::string("\x80"), std::string("\x00", 1)));
}

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

/// How many changes a seat that tries all the time makes within `seconds`.
int changes(ChangeLimit& limit, int seat, double from_s, double seconds) {
    int count = 0;
    for (double now_s = from_s; now_s < from_s + seconds; now_s += 0.1) {
        if (!limit.allowed(seat, now_s)) continue;
        limit.changed(seat, now_s);
        ++count;
    }
    return count;
}

TEST(ChangeLimit, IsSixtyAtOnceAndThirtyAMinuteForASeat) {
    ChangeLimit limit;
    // A hundred tries: sixty at once, five that ten seconds give.
    EXPECT_NEAR(changes(limit, 1, 1000.0, 10.0), 65, 1);
    EXPECT_NEAR(changes(limit, 1, 1010.0, 60.0), 30, 1);
    EXPECT_NEAR(changes(limit, 2, 1010.0, 5.0), 50, 1) << "others are free";
}

TEST(ChangeLimit, GoesOnAfterAClockThatGoesBack) {
    ChangeLimit limit;
    changes(limit, 1, 1000.0, 20.0);
    EXPECT_FALSE(limit.allowed(1, 10.0)) << "gives nothing";
    limit.changed(1, 10.0);
    EXPECT_TRUE(limit.allowed(1, 20.0)) << "takes nothing either";
}

}  // namespace
}  // namespace livery
