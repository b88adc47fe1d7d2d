#include <algorithm>
#include <cstdint>
#include <string>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>

#include "core/image_io.h"
#include "support/file_error.h"
#include "support/temporary_folder.h"

namespace livery {
namespace {

std::string little_endian(std::uint32_t value, int bytes) {
    std::string text;
    for (int k = 0; k < bytes; ++k) text.push_back(static_cast<char>(value >> (8 * k)));
    return text;
}

/// A 64x64 DNG (a TIFF with a Bayer pattern R G / G B, 16 bit) that is uniform in each colour and
/// asks for a white balance of 2, 1, 1.43.
std::string dng(std::uint16_t red, std::uint16_t green, std::uint16_t blue, std::uint32_t black) {
    constexpr std::uint32_t side = 64, entry_count = 24;
    constexpr std::uint32_t data_at = 8 + 2 + 12 * entry_count + 4;
    std::vector<std::tuple<std::uint32_t, std::string>> entries;  // tag, the entry's 12 bytes
    std::string data;
    const auto add = [&](std::uint32_t tag, std::uint32_t type, std::uint32_t n, std::string raw) {
        std::string value = raw;
        if (raw.size() > 4) {
            value = little_endian(data_at + static_cast<std::uint32_t>(data.size()), 4);
            data += raw;
        }
        value.resize(4);
        entries.emplace_back(
            tag, little_endian(tag, 2) + little_endian(type, 2) + little_endian(n, 4) + value);
    };
    const auto shorts = [&](std::uint32_t tag, std::uint32_t value) {
        add(tag, 3, 1, little_endian(value, 2));
    };
    const auto longs = [&](std::uint32_t tag, std::uint32_t value) {
        add(tag, 4, 1, little_endian(value, 4));
    };
    const auto ratios = [&](std::uint32_t tag, std::uint32_t type, std::vector<double> values) {
        std::string raw;
        for (const double value : values) {
            raw += little_endian(static_cast<std::uint32_t>(value * 1e4), 4) +
                   little_endian(10'000, 4);
        }
        add(tag, type, static_cast<std::uint32_t>(values.size()), raw);
    };
    longs(254, 0);
    longs(256, side);
    longs(257, side);
    shorts(258, 16);
    shorts(259, 1);      // not compressed
    shorts(262, 32803);  // colour filter array
    add(271, 2, 6, std::string("Maker\0", 6));
    add(272, 2, 6, std::string("Model\0", 6));
    shorts(274, 1);
    shorts(277, 1);
    longs(278, side);
    longs(279, side * side * 2);
    shorts(284, 1);
    add(33421, 3, 2, little_endian(2, 2) + little_endian(2, 2));
    add(33422, 1, 4, std::string("\0\1\1\2", 4));
    add(50706, 1, 4, std::string("\1\4\0\0", 4));
    add(50708, 2, 12, std::string("Maker Model\0", 12));
    longs(50714, black);
    longs(50717, 65535);
    ratios(50721, 10, {1, 0, 0, 0, 1, 0, 0, 0, 1});
    ratios(50728, 5, {0.5, 1.0, 0.7});
    shorts(50778, 21);
    longs(50730, 0);
    longs(273, data_at + static_cast<std::uint32_t>(data.size()));
    std::sort(entries.begin(), entries.end());

    std::string file = std::string("II*\0", 4) + little_endian(8, 4) +
                       little_endian(static_cast<std::uint32_t>(entries.size()), 2);
    for (const auto& [tag, entry] : entries) file += entry;
    file.resize(data_at);
    file += data;
    for (std::uint32_t y = 0; y < side; ++y) {
        for (std::uint32_t x = 0; x < side; ++x) {
            const bool odd_x = x % 2 == 1, odd_y = y % 2 == 1;
            file += little_endian(odd_x != odd_y ? green : odd_x ? blue : red, 2);
        }
    }
    return file;
}

TEST(RawPicture, GivesTheCamerasOwnLinearColour) {
    const TemporaryFolder folder;
    const auto read = read_image(folder.write("a.DNG", dng(10'000, 20'000, 5'000, 0)));
    EXPECT_EQ(read.full_scale, 65535.0);
    ASSERT_EQ(read.image.channels, 3);
    EXPECT_EQ(read.channel_names, (std::vector<std::string>{"R", "G", "B"}));
    // Within one step of rounding; a white balance would double red, a curve would triple it.
    for (const int at : {20, 33}) {
        EXPECT_NEAR(read.image.at(at, at, 0), 10'000.0f, 1.0f);
        EXPECT_NEAR(read.image.at(at, at, 1), 20'000.0f, 1.0f);
        EXPECT_NEAR(read.image.at(at, at, 2), 5'000.0f, 1.0f);
    }
}

TEST(RawPicture, BlackIsSubtractedAndSaturationIsFullScale) {
    const TemporaryFolder folder;
    const auto read = read_image(folder.write("a.dng", dng(3'535, 35'535, 65'535, 3'535)));
    const double scale = 65'535.0 / (65'535.0 - 3'535.0);
    EXPECT_NEAR(read.image.at(33, 33, 0), 0.0, 1.0);
    EXPECT_NEAR(read.image.at(33, 33, 1), 32'000.0 * scale, 2.0);
    EXPECT_NEAR(read.image.at(33, 33, 2), 65'535.0, 1.0);
}

/// However the camera says that it was held, so that pixels keep their places in a sequence.
TEST(RawPicture, IsNotTurned) {
    const TemporaryFolder folder;
    std::string file = dng(10'000, 20'000, 5'000, 0);
    constexpr std::ptrdiff_t half = 64 * 32 * 2;
    std::fill_n(file.end() - 2 * half, half, '\0');         // the upper half is dark
    const std::string held("\x12\x01\x03\0\x01\0\0\0", 8);  // Orientation, one short
    const std::size_t entry = file.find(held);
    ASSERT_NE(entry, std::string::npos);
    for (const char orientation : {'\1', '\3', '\6', '\x8'}) {
        file[entry + held.size()] = orientation;
        const auto read = read_image(folder.write("a.dng", file));
        for (const int x : {20, 44}) {
            EXPECT_EQ(read.image.at(x, 10, 1), 0.0f) << "orientation " << int{orientation};
            EXPECT_NEAR(read.image.at(x, 54, 1), 20'000.0f, 1.0f)
                << "orientation " << int{orientation};
        }
    }
}

TEST(RawPicture, BadFilesSayWhy) {
    const TemporaryFolder folder;
    const auto whole = dng(1, 2, 3, 0);
    const auto fails = [&](const std::string& bytes) {
        return fails_with([&] { read_image(folder.write("a.dng", bytes)); },
                          {"a.dng: found", "expected"});
    };
    EXPECT_TRUE(fails(""));
    EXPECT_TRUE(fails("not a photograph"));
    EXPECT_TRUE(fails(whole.substr(0, 100)));
    EXPECT_TRUE(fails(whole.substr(0, whole.size() / 2)));
}

}  // namespace
}  // namespace livery
