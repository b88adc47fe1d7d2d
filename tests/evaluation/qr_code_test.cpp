#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "evaluation/phone_page.h"
#include "support/zbar.h"

namespace livery {
namespace {

/// Drawn with its quiet zone, six pixels a module.
std::string read_back(const ZBar& reader, const QrCode& code) {
    constexpr int kPixels = 6;
    const int side = kPixels * (code.size + 2 * kQrQuietZone);
    std::vector<unsigned char> grey;
    for (int y = 0; y < side; ++y) {
        for (int x = 0; x < side; ++x) {
            const bool dark = code.at(x / kPixels - kQrQuietZone, y / kPixels - kQrQuietZone);
            grey.push_back(dark ? 0 : 255);
        }
    }
    return reader.read(grey, side, side);
}

TEST(QrCodes, AreReadByOthers) {
    const ZBar reader;
    ASSERT_TRUE(reader.is_there()) << "libzbar.so.0 is not installed";
    for (const std::string& text : {std::string("http://192.168.178.123:8470/join/"
                                                "0123456789abcdef0123456789abcdef"),
                                    std::string("https://livery.local/"),
                                    std::string(300, 'x')}) {
        EXPECT_EQ(read_back(reader, qr_code(text)), text);
    }
}

TEST(QrCodes, HoldTheAddressToJoinAt) {
    const BallotServerPlace place{"192.168.178.123", 8470, false, "wlan0"};
    const std::string url = join_url(place, "0123456789abcdef0123456789abcdef");
    EXPECT_EQ(url, "http://192.168.178.123:8470/join/0123456789abcdef0123456789abcdef");
    const QrCode code = qr_code(url);
    EXPECT_EQ(code.dark.size(), static_cast<std::size_t>(code.size * code.size));
    // At most version 5: on a phone's picture of a wall, few modules are large ones.
    EXPECT_LE(code.size, 37);
    EXPECT_FALSE(code.at(-1, 0));
    EXPECT_FALSE(code.at(0, code.size));
    EXPECT_TRUE(code.at(0, 0)) << "the finder pattern's corner";
}

TEST(QrCodes, InATerminalHaveTheirQuietZone) {
    const QrCode code = qr_code("http://127.0.0.1:8470/");
    const std::string text = qr_text(code);
    int lines = 0;
    for (const char c : text) lines += c == '\n' ? 1 : 0;
    EXPECT_EQ(lines, (code.size + 2 * kQrQuietZone + 1) / 2);
    // Four light modules are two lines of nothing.
    const std::string first = text.substr(0, text.find('\n'));
    EXPECT_EQ(first.find("█"), std::string::npos);
    EXPECT_EQ(first.find("▀"), std::string::npos);
}

TEST(QrCodes, OfNothingOrTooMuchThereAreNone) {
    EXPECT_THROW(qr_code(""), std::invalid_argument);
    EXPECT_THROW(qr_code(std::string(4000, 'x')), std::invalid_argument);
}

TEST(BallotPlaces, AreSaidAndRead) {
    BallotServerPlace place{"192.168.0.7", 443, true, "wlan0", {"livery.local"}};
    const BallotServerPlace read = parse_ballot_place(text_of(place));
    EXPECT_EQ(text_of(read), text_of(place));
    EXPECT_EQ(url_of(place), "https://livery.local/");
    EXPECT_EQ(words_for(place).find("plain HTTP"), std::string::npos);
    place.tls = false;
    EXPECT_EQ(url_of(place), "http://livery.local:443/");
    EXPECT_NE(words_for(place).find("plain HTTP: whoever can listen to that network can see votes"),
              std::string::npos);
    const BallotServerPlace here{"127.0.0.1", 8470, false, "lo"};
    EXPECT_NE(words_for(here).find("Only this machine"), std::string::npos);
    EXPECT_THROW(parse_ballot_place("livery-ballots: no"), std::exception);
}

}  // namespace
}  // namespace livery
