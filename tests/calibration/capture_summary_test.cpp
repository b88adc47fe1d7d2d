// How far a photograph is displaced against another, by means over blocks of its pixels.
#include "calibration/captures/capture_summary.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/random.h"

namespace livery {
namespace {

constexpr int kPhotographWidth = 960, kPhotographHeight = 600;
constexpr int kFine = 4;  ///< places within a pixel that a picture may be moved to
constexpr std::uint64_t kSeed = 7;

/// Boxes of any reflectance before one another, with hard edges, as a camera sees them from a place
/// that lies `moved` fine steps aside.
RoledPhotograph photograph(glm::ivec2 moved, float light) {
    constexpr int kMargin = 16 * kFine;
    const int width = kPhotographWidth * kFine, height = kPhotographHeight * kFine;
    ImageF scene(width + 2 * kMargin, height + 2 * kMargin, 1, 0.3f);
    Random random(kSeed);
    for (int k = 0; k < 500; ++k) {
        const auto within = [&](int most) {
            return static_cast<int>(random.below(static_cast<std::uint32_t>(most)));
        };
        const int left = within(scene.width), top = within(scene.height);
        const int right = std::min(left + 40 + within(500), scene.width),
                  bottom = std::min(top + 40 + within(400), scene.height);
        const auto reflectance = static_cast<float>(std::exp(random.uniform() * 3.0 - 3.0));
        for (int y = top; y < bottom; ++y)
            for (int x = left; x < right; ++x) scene.at(x, y) = reflectance;
    }
    RoledPhotograph shot;
    shot.role = "white";
    shot.photograph.image = ImageF(kPhotographWidth, kPhotographHeight, 1);
    Random noise(kSeed + 1);
    for (int y = 0; y < kPhotographHeight; ++y)
        for (int x = 0; x < kPhotographWidth; ++x) {
            float sum = 0.0f;
            for (int v = 0; v < kFine; ++v)
                for (int u = 0; u < kFine; ++u)
                    sum += scene.at(kMargin + x * kFine + u - moved.x,
                                    kMargin + y * kFine + v - moved.y);
            const float mean = light * sum / static_cast<float>(kFine * kFine);
            shot.photograph.image.at(x, y) =
                mean + 0.01f * std::sqrt(mean) * static_cast<float>(noise.normal());
        }
    return shot;
}

TEST(CaptureSummary, ToldDisplacementsAreThoseOfTheCamera) {
    std::printf("seed %d\n", static_cast<int>(kSeed));
    const CaptureSummary still = summarise(photograph({0, 0}, 1.0f));
    const int block_px = summary_block_px(kPhotographWidth);
    ASSERT_EQ(block_px, 4);
    const Image8 all(still.light.width, still.light.height, 1, 255);
    const auto blocks = texture_blocks(still.light, all);
    // From an eighth of a block to four of them, along both axes and aslant
    for (const glm::ivec2 moved : {glm::ivec2(2, 0),
                                   glm::ivec2(0, -3),
                                   glm::ivec2(4, 4),
                                   glm::ivec2(-6, 0),
                                   glm::ivec2(3, -5),
                                   glm::ivec2(12, 0),
                                   glm::ivec2(24, 8),
                                   glm::ivec2(-40, 36)}) {
        const CaptureSummary other = summarise(photograph(moved, 0.3f));
        const glm::dvec2 told =
            static_cast<double>(block_px) * glm::dvec2(displacement(blocks, other.light));
        const glm::dvec2 truth = glm::dvec2(moved) / static_cast<double>(kFine);
        std::printf(
            "    (%6.2f, %6.2f) px: told (%6.2f, %6.2f)\n", truth.x, truth.y, told.x, told.y);
        // A tenth, since 1.3 px is refused and 1.2 px is not; a twentieth of a pixel is noise
        EXPECT_LT(glm::distance(told, truth), 0.05 + 0.1 * glm::length(truth));
    }
}

TEST(CaptureSummary, WhatHasNoTextureTellsNoDisplacement) {
    const ImageF even(60, 40, 1, 0.5f);
    const Image8 all(60, 40, 1, 255);
    const glm::vec2 told = displacement(texture_blocks(even, all), even);
    EXPECT_TRUE(std::isnan(told.x) && std::isnan(told.y));
}

}  // namespace
}  // namespace livery
