// Real photographs of a printed board under Gray code, and the speed beside OpenCV's decoder.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>

#include <gtest/gtest.h>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/structured_light.hpp>

#include "calibration/correspondence/gray_code.h"
#include "core/image_io.h"
#include "core/time.h"
#include "support/reference_data.h"

namespace livery {
namespace {

std::vector<Image8> load_pose(const std::filesystem::path& folder) {
    std::vector<Image8> pictures;
    for (int i = 0; i < 42; ++i) {
        char name[32];
        std::snprintf(name, sizeof(name), "graycode_%02d.png", i);
        const ImageFile file = read_image(folder / name);
        Image8 picture(file.image.width, file.image.height, 1);
        for (std::size_t k = 0; k < picture.values.size(); ++k)
            picture.values[k] = static_cast<std::uint8_t>(
                file.image.values[k * static_cast<std::size_t>(file.image.channels)]);
        pictures.push_back(std::move(picture));
    }
    return pictures;
}

TEST(RealPhotographs, LitPixelsOfTheBoardLieOnItsPlaneAndDecodingIsFast) {
    LIVERY_NEEDS_REFERENCE_DATA(data);
    const auto pictures = load_pose(data / "procam" / "capture_0");
    const int width = pictures[0].width, height = pictures[0].height;
    std::vector<cv::Mat> mats;
    for (const Image8& picture : pictures)
        mats.emplace_back(height, width, CV_8UC1, const_cast<std::uint8_t*>(picture.values.data()));

    std::vector<cv::Point2f> corners;
    ASSERT_TRUE(cv::findChessboardCorners(mats[40], cv::Size(9, 7), corners));
    std::vector<cv::Point2f> hull;
    cv::convexHull(corners, hull);

    // Both decoders from the same pictures in memory; the best of several runs
    double own = 1e9;
    CameraToProjector result;
    for (int run = 0; run < 7; ++run) {
        const auto start = std::chrono::steady_clock::now();
        result = decode_gray_code(std::span<const Image8>(pictures), 1024, 768);
        own = std::min(own, seconds_since(start));
    }
    const auto opencv = cv::structured_light::GrayCodePattern::create(1024, 768);
    const std::vector<cv::Mat> stripes(mats.begin(), mats.begin() + 40);
    const auto start = std::chrono::steady_clock::now();
    std::size_t same = 0, compared = 0;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            cv::Point place;
            if (opencv->getProjPixel(stripes, x, y, place) || !result.decoded.at(x, y)) continue;
            ++compared;
            same += result.projector_px.at(x, y, 0) == static_cast<float>(place.x) + 0.5f &&
                    result.projector_px.at(x, y, 1) == static_cast<float>(place.y) + 0.5f;
        }
    const double theirs = seconds_since(start);
    std::printf("decode 1280x1024x42: %.1f ms; GrayCodePattern %.0f ms: %.0f times\n",
                1e3 * own,
                1e3 * theirs,
                theirs / own);
    EXPECT_GT(compared, 100000u);
    EXPECT_EQ(same, compared);  // where both answer, they agree

    // Lit pixels of the board against the local homography of their neighbourhood
    cv::Mat projector(height, width, CV_32FC2);
    std::size_t lit = 0, near = 0, lost = 0;
    constexpr int kTile = 48;
    const cv::Rect box = cv::boundingRect(hull);
    for (int top = box.y; top < box.y + box.height; top += kTile)
        for (int left = box.x; left < box.x + box.width; left += kTile) {
            std::vector<cv::Point2f> from, to;
            const auto on_board = [&](int x, int y) {
                return x < width && y < height &&
                       pictures[40].at(x, y) - pictures[41].at(x, y) > 20 &&
                       cv::pointPolygonTest(
                           hull, cv::Point2f(static_cast<float>(x), static_cast<float>(y)), false) >
                           0;
            };
            for (int y = top; y < top + kTile; ++y)
                for (int x = left; x < left + kTile; ++x) {
                    if (!on_board(x, y)) continue;
                    ++lit;
                    if (!result.decoded.at(x, y)) {
                        ++lost;
                        continue;
                    }
                    from.emplace_back(static_cast<float>(x), static_cast<float>(y));
                    to.emplace_back(result.projector_px.at(x, y, 0),
                                    result.projector_px.at(x, y, 1));
                }
            if (from.size() < 40) continue;
            const cv::Mat h = cv::findHomography(from, to, cv::RANSAC, 1.5, cv::noArray(), 200);
            if (h.empty()) continue;
            std::vector<cv::Point2f> mapped;
            cv::perspectiveTransform(from, mapped, h);
            for (std::size_t i = 0; i < mapped.size(); ++i)
                near += std::hypot(mapped[i].x - to[i].x, mapped[i].y - to[i].y) <= 2.0;
        }
    std::printf("board: %zu lit pixels, %.2f%% within 2 px of the plane, %.2f%% not decoded\n",
                lit,
                100.0 * static_cast<double>(near) / static_cast<double>(lit),
                100.0 * static_cast<double>(lost) / static_cast<double>(lit));
    EXPECT_GT(lit, 100000u);
    EXPECT_GE(static_cast<double>(near), 0.95 * static_cast<double>(lit));
}

}  // namespace
}  // namespace livery
