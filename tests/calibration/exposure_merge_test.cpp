#include "calibration/captures/exposure_merge.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <opencv2/photo.hpp>

#include "core/random.h"

namespace livery {
namespace {

constexpr double kBlack = 1024.0, kFull = 16383.0;

/// A column a brightness, from 1 to 2000 units a second.
double light_at(int x, int width) { return std::pow(2000.0, x / (width - 1.0)); }

/// 14 bit, 4 electrons a unit, read noise of 3 units.
Photograph noisy_photograph(int width, int height, double exposure_s, std::uint64_t seed) {
    Photograph photograph;
    photograph.image = ImageF(width, height, 3);
    photograph.exposure_s = exposure_s;
    photograph.black_level = kBlack;
    photograph.saturates_at = kFull;
    Random random(seed);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            for (int c = 0; c < 3; ++c) {
                const double signal = light_at(x, width) * exposure_s;
                const double value =
                    kBlack + signal + std::sqrt(signal / 4.0 + 9.0) * random.normal();
                photograph.image.at(x, y, c) =
                    static_cast<float>(std::clamp(std::round(value), 0.0, kFull));
            }
        }
    }
    return photograph;
}

/// Root mean square of the relative error, over the picture.
template <typename Light>
double relative_error(int width, int height, const Light& light) {
    double squares = 0.0;
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const double off = light(x, y) / light_at(x, width) - 1.0;
            squares += off * off;
        }
    }
    return std::sqrt(squares / (width * height));
}

TEST(ExposureMerge, CountsOverTimeLeaveLessNoiseThanOpenCv) {
    constexpr int kWidth = 200, kHeight = 60;
    MergedPhotographs merged;
    std::vector<cv::Mat> eight_bit;
    std::vector<float> times;
    std::uint64_t seed = 1;
    for (const double exposure_s : {5.0, 40.0, 320.0}) {
        const Photograph photograph = noisy_photograph(kWidth, kHeight, exposure_s, seed++);
        add(photograph, merged);
        cv::Mat picture(kHeight, kWidth, CV_8UC3);
        for (int y = 0; y < kHeight; ++y) {
            for (int x = 0; x < kWidth; ++x) {
                for (int c = 0; c < 3; ++c) {
                    const double share =
                        (static_cast<double>(photograph.image.at(x, y, c)) - kBlack) /
                        (kFull - kBlack);
                    picture.at<cv::Vec3b>(y, x)[c] = cv::saturate_cast<uchar>(255.0 * share);
                }
            }
        }
        eight_bit.push_back(picture);
        times.push_back(static_cast<float>(exposure_s));
    }
    cv::Mat response(256, 1, CV_32FC3), opencv;
    for (int k = 0; k < 256; ++k) {
        const auto linear = static_cast<float>(std::max(k, 1) / 255.0 * (kFull - kBlack));
        response.at<cv::Vec3f>(k) = {linear, linear, linear};
    }
    cv::createMergeDebevec()->process(eight_bit, opencv, times, response);

    const double ours = relative_error(kWidth, kHeight, [&](int x, int y) {
        return double(merged.counts.at(x, y, 1)) / double(merged.seconds.at(x, y, 1));
    });
    const double theirs = relative_error(
        kWidth, kHeight, [&](int x, int y) { return double(opencv.at<cv::Vec3f>(y, x)[1]); });
    fmt::print("rms error: counts over time {:.4f}, MergeDebevec of 8 bits {:.4f}: {:.1f} times\n",
               ours,
               theirs,
               theirs / ours);
    EXPECT_LT(ours, 0.015);
    EXPECT_GT(theirs, 4.0 * ours);
}

TEST(ExposureMerge, IsUnbiasedFromDarkToBright) {
    constexpr int kWidth = 9, kHeight = 4000;
    MergedPhotographs merged;
    for (const double exposure_s : {0.05, 0.4, 3.2}) {
        add(noisy_photograph(kWidth, kHeight, exposure_s, 7), merged);
    }
    for (int x = 0; x < kWidth; ++x) {
        double sum = 0.0;
        for (int y = 0; y < kHeight; ++y) {
            sum += double(merged.counts.at(x, y, 0)) / double(merged.seconds.at(x, y, 0));
        }
        // Signals of less than a unit too: nothing is clipped at black.
        EXPECT_NEAR(sum / kHeight / light_at(x, kWidth), 1.0, x < 2 ? 0.06 : 0.01) << x;
    }
}

TEST(ExposureMerge, LeavesOutWhatSaturates) {
    const auto uniform = [](float value, double exposure_s) {
        Photograph photograph;
        photograph.image = ImageF(2, 1, 3, value);
        photograph.exposure_s = exposure_s;
        photograph.black_level = 10.0;
        photograph.saturates_at = 1010.0;
        return photograph;
    };
    MergedPhotographs merged;
    add(uniform(110.0f, 0.5), merged);
    add(uniform(410.0f, 2.0), merged);
    add(uniform(970.0f, 8.0), merged);  // over 95% of the range
    EXPECT_FLOAT_EQ(merged.counts.at(1, 0, 2), 500.0f);
    EXPECT_FLOAT_EQ(merged.seconds.at(1, 0, 2), 2.5f);
    MergedPhotographs blown;
    add(uniform(1010.0f, 1.0), blown);
    EXPECT_EQ(blown.seconds.at(0, 0, 0), 0.0f);
    EXPECT_THROW(add(uniform(20.0f, 0.0), merged), std::invalid_argument);
    Photograph other = uniform(20.0f, 1.0);
    other.image = ImageF(3, 1, 3);
    EXPECT_THROW(add(other, merged), std::invalid_argument);
}

TEST(ExposureMerge, WindowsAverageBlocks) {
    Photograph photograph;
    photograph.image = ImageF(7, 5, 3);
    photograph.saturates_at = 100.0;
    for (int y = 0; y < 5; ++y) {
        for (int x = 0; x < 7; ++x) {
            for (int c = 0; c < 3; ++c)
                photograph.image.at(x, y, c) = static_cast<float>(x + 10 * y);
        }
    }
    photograph.image.at(5, 3, 1) = 99.0f;
    const Photograph small = windowed(photograph, {1, 0, 3, 2, 2});
    ASSERT_EQ(small.image.width, 3);
    ASSERT_EQ(small.image.height, 2);
    EXPECT_FLOAT_EQ(small.image.at(0, 0, 0), 0.25f * (1.0f + 2.0f + 11.0f + 12.0f));
    EXPECT_FLOAT_EQ(small.image.at(2, 1, 0), 0.25f * (25.0f + 26.0f + 35.0f + 36.0f));
    // One saturated pixel is a saturated block.
    EXPECT_FLOAT_EQ(small.image.at(2, 1, 1), 100.0f);
    EXPECT_THROW(windowed(photograph, {1, 0, 4, 2, 2}), std::invalid_argument);
    EXPECT_THROW(windowed(photograph, {-1, 0, 1, 1, 1}), std::invalid_argument);
    EXPECT_THROW(windowed(photograph, {0, 0, 1, 1, 0}), std::invalid_argument);
}

}  // namespace
}  // namespace livery
