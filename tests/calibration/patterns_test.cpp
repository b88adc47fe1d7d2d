#include "calibration/correspondence/patterns.h"

#include <algorithm>
#include <set>
#include <vector>

#include <gtest/gtest.h>

namespace livery {
namespace {

TEST(GeometryPatterns, EveryColumnAndRowHasItsOwnCodeAndNeighboursDifferInOneBit) {
    const auto patterns = geometry_patterns(200, 75);
    ASSERT_EQ(patterns.size(), 2u * (8 + 7) + 2u);
    const auto code_at = [&](int x, int y, const std::string& axis, int bits) {
        unsigned code = 0;
        for (int bit = 0; bit < bits; ++bit)
            for (const Pattern& p : patterns)
                if (p.role == "gray-" + axis + "-" + std::to_string(bit))
                    code = code << 1 | (p.drive.at(x, y) == 255 ? 1u : 0u);
        return code;
    };
    std::set<unsigned> columns, rows;
    for (int x = 0; x < 200; ++x) {
        columns.insert(code_at(x, 10, "column", 8));
        if (x > 0) {
            EXPECT_EQ(
                __builtin_popcount(code_at(x, 10, "column", 8) ^ code_at(x - 1, 10, "column", 8)),
                1);
        }
    }
    for (int y = 0; y < 75; ++y) rows.insert(code_at(3, y, "row", 7));
    EXPECT_EQ(columns.size(), 200u);
    EXPECT_EQ(rows.size(), 75u);
    // Bit 0 is the most significant: one step, in the middle of the code.
    EXPECT_EQ(patterns[0].role, "gray-column-0");
    EXPECT_EQ(patterns[0].drive.at(127, 0), 0);
    EXPECT_EQ(patterns[0].drive.at(128, 0), 255);
}

TEST(GeometryPatterns, EachBitIsFollowedByItsInverseThenWhiteThenBlack) {
    const auto patterns = geometry_patterns(1024, 768);
    ASSERT_EQ(patterns.size(), 42u);
    for (std::size_t i = 0; i < 40; i += 2) {
        EXPECT_EQ(patterns[i + 1].role, patterns[i].role + "-inverse");
        for (std::size_t k = 0; k < patterns[i].drive.values.size(); k += 997)
            EXPECT_EQ(patterns[i].drive.values[k] + patterns[i + 1].drive.values[k], 255);
    }
    EXPECT_EQ(patterns[20].role, "gray-row-0");
    EXPECT_EQ(patterns[40].role, "white");
    EXPECT_EQ(patterns[40].drive_values, (std::vector<int>{255, 255, 255}));
    EXPECT_EQ(patterns[41].role, "black");
    EXPECT_EQ(patterns[41].drive_values, (std::vector<int>{0, 0, 0}));
}

TEST(ColourPatterns, AreTheSixOfTheMethod) {
    const auto patterns = colour_patterns(640, 400, 64, 200);
    ASSERT_EQ(patterns.size(), 6u);
    const std::vector<std::pair<std::string, std::vector<int>>> expected = {
        {"dark-gray", {64, 64, 64}},
        {"bright-gray", {200, 200, 200}},
        {"red", {200, 64, 64}},
        {"green", {64, 200, 64}},
        {"blue", {64, 64, 200}},
        {"gray-levels", {}}};
    for (std::size_t i = 0; i < 6; ++i) {
        EXPECT_EQ(patterns[i].role, expected[i].first);
        EXPECT_EQ(patterns[i].drive_values, expected[i].second);
    }
    EXPECT_EQ(patterns[2].drive.at(639, 399, 0), 200);
    EXPECT_EQ(patterns[2].drive.at(639, 399, 1), 64);
}

/// Side of the smallest run of equal colour inside the picture, along rows and columns.
int smallest_block(const Image8& drive) {
    int smallest = drive.width;
    for (int y = 0; y < drive.height; y += 5) {
        int run = 0;
        bool first = true;
        for (int x = 0; x < drive.width; ++x) {
            const bool same =
                x > 0 &&
                std::equal(drive.pixel(x, y), drive.pixel(x, y) + 3, drive.pixel(x - 1, y));
            if (x > 0 && !same) {
                if (!first) smallest = std::min(smallest, run);
                first = false;
                run = 0;
            }
            ++run;
        }
    }
    return smallest;
}

TEST(ColourPatterns, GreyLevelsLieInBlocksTheDarkOnesDenser) {
    for (const int width : {160, 640, 1280, 1920}) {
        const Image8 drive = colour_patterns(width, width * 5 / 8, 0, 255).back().drive;
        const int block = smallest_block(drive);
        EXPECT_EQ(block, width == 160 ? 8 : 16) << width;
        std::vector<int> count(256, 0);
        int blocks = 0;
        for (int y = block / 2; y < drive.height; y += block)
            for (int x = block / 2; x < drive.width; x += block) {
                ++count[drive.at(x, y)];
                ++blocks;
            }
        // A quarter black, a sixteenth white, whichever part of the picture the mock-up takes
        EXPECT_NEAR(count[0], 0.25 * blocks, 0.06 * blocks) << width;
        EXPECT_NEAR(count[255], blocks / 16.0, 0.03 * blocks) << width;
        int dark = 0, middle = 0, largest_gap = 0, last = 0;
        for (int level = 1; level < 255; ++level) {
            if (level <= 64) dark += count[static_cast<std::size_t>(level)];
            if (level > 96 && level <= 160) middle += count[static_cast<std::size_t>(level)];
            if (count[static_cast<std::size_t>(level)] == 0) continue;
            largest_gap = std::max(largest_gap, level - last);
            last = level;
        }
        EXPECT_GT(dark, 1.3 * middle) << width;
        EXPECT_LE(largest_gap, width >= 640 ? 6 : 40) << width;
    }
}

// Light scatters from block to block: black ones must not lie more brightly than others.
TEST(ColourPatterns, GreyLevelsHaveNeighboursAlike) {
    const Image8 drive = colour_patterns(1920, 1200, 0, 255).back().drive;
    const int block = smallest_block(drive);
    double of_black = 0.0, blacks = 0.0, of_others = 0.0, others = 0.0;
    for (int y = block + block / 2; y + block < drive.height; y += block)
        for (int x = block + block / 2; x + block < drive.width; x += block) {
            const double around = drive.at(x - block, y) + drive.at(x + block, y) +
                                  drive.at(x, y - block) + drive.at(x, y + block);
            (drive.at(x, y) == 0 ? of_black : of_others) += around / 4.0;
            (drive.at(x, y) == 0 ? blacks : others) += 1.0;
        }
    // Four standard errors of the mean of some 2000 blocks
    EXPECT_NEAR(of_black / blacks, of_others / others, 5.0);
}

TEST(MosaicPatterns, HoldRampsOfEveryKindAndFillTheCube) {
    const auto patterns = mosaic_patterns(1280, 800, 6);
    ASSERT_EQ(patterns.size(), 6u);
    std::set<int> red_only, grey, octants;
    for (std::size_t i = 0; i < patterns.size(); ++i) {
        EXPECT_EQ(patterns[i].role, "colors-" + std::to_string(i));
        EXPECT_GE(smallest_block(patterns[i].drive), 8);
        // A car at 2.75 m covers no more than this
        for (int y = 300; y < 400; y += 4)
            for (int x = 500; x < 640; x += 4) {
                const std::uint8_t* const d = patterns[i].drive.pixel(x, y);
                if (d[1] == 0 && d[2] == 0) red_only.insert(d[0]);
                if (d[0] == d[1] && d[1] == d[2]) grey.insert(d[0]);
                octants.insert((d[0] > 127) + 2 * (d[1] > 127) + 4 * (d[2] > 127));
            }
    }
    EXPECT_GE(red_only.size(), 12u);
    EXPECT_GE(grey.size(), 12u);
    EXPECT_EQ(octants.size(), 8u);
}

TEST(Patterns, RefuseSenselessSizesAndDrives) {
    EXPECT_THROW(geometry_patterns(1, 100), std::invalid_argument);
    EXPECT_THROW(geometry_patterns(100, 20000), std::invalid_argument);
    EXPECT_THROW(colour_patterns(100, 100, 200, 100), std::invalid_argument);
    EXPECT_THROW(colour_patterns(100, 100, 0, 256), std::invalid_argument);
    EXPECT_THROW(mosaic_patterns(100, 100, 0), std::invalid_argument);
    EXPECT_THROW(mosaic_patterns(0, 100, 2), std::invalid_argument);
}

}  // namespace
}  // namespace livery
