#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/image_io.h"
#include "support/dng.h"
#include "support/file_error.h"
#include "support/temporary_folder.h"

namespace livery {
namespace {

/// Uniform in each colour, asking for a white balance of 2, 1, 1.43.
std::string dng(std::uint16_t red, std::uint16_t green, std::uint16_t blue, std::uint32_t black) {
    return testing::dng_of(
        64, 64, black, [=](int x, int y) { return testing::bayer(x, y, red, green, blue); });
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

TEST(RawPicture, WhatIsNoPictureIsRefusedAtHalfSizeToo) {
    const TemporaryFolder folder;
    for (const char* name : {"a.dng", "a.png", "a.jpg"}) {
        const auto file = folder.write(name, "half a photograph");
        EXPECT_TRUE(fails_with([&] { read_image(file, kMostPicturePixels, true); },
                               {std::string(name) + ": found", "expected"}));
    }
}

}  // namespace
}  // namespace livery
