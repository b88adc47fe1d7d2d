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

}  // namespace
}  // namespace livery
