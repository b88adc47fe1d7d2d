// Lenses and their places from boards: against known ones, and real photographs beside OpenCV.
#include <atomic>
#include <cmath>
#include <cstdio>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

#include "calibration/correspondence/gray_code.h"
#include "calibration/geometry/homography.h"
#include "calibration/geometry/solve_pair.h"
#include "calibration/registration/rotation.h"
#include "calibration/support/board_sights.h"
#include "core/error.h"
#include "core/image_io.h"
#include "support/reference_data.h"

namespace livery {
namespace {

using testing::board_points_mm;
using testing::board_sights;
using testing::kCamera;
using testing::kProjector;
using testing::kTurns;
using testing::pair_truth;
using testing::PairTruth;

TEST(Geometry, LensesAndTheirPlacesAreFoundWithALensShift) {
    constexpr std::uint32_t kSeed = 5;
    std::printf("seed %u\n", kSeed);
    const PairTruth t = pair_truth();
    const auto exact = solve_pair(board_sights(t, kTurns, 0.0, kSeed), kCamera, kProjector);
    EXPECT_NEAR(exact.camera.focal_px.x, 2400, 0.5);
    EXPECT_NEAR(exact.projector.focal_px.y, 1905, 0.5);
    EXPECT_NEAR(exact.projector.principal_px.y, 980, 0.5);
    EXPECT_NEAR(exact.camera.distortion[0], -0.12, 2e-3);

    const auto noisy = solve_pair(board_sights(t, kTurns, 0.1, kSeed), kCamera, kProjector);
    EXPECT_NEAR(noisy.camera.focal_px.x, 2400, 24);
    EXPECT_NEAR(noisy.projector.focal_px.x, 1900, 19);
    EXPECT_LT(noisy.projector_rms_px, 0.2);
    EXPECT_GT(noisy.projector_standard_error_px[0], 0.1);
    EXPECT_LT(noisy.projector_standard_error_px[0], 19);
    const Rigid3 off = noisy.projector.view_from_world * inverse(t.projector.view_from_world);
    EXPECT_LT(angle_of(off.rotation), 0.01);
}

TEST(Geometry, WhatDoesNotDetermineTheLensesIsRefused) {
    const PairTruth t = pair_truth();
    const std::vector<glm::dvec3> parallel(5, {0.3, 0.1, 0});
    EXPECT_THROW(solve_pair(board_sights(t, parallel, 0.1, 1), kCamera, kProjector), Refused);
    EXPECT_THROW(solve_pair(board_sights(t, {kTurns[0], kTurns[2]}, 0.1, 1), kCamera, kProjector),
                 Refused);
}

TEST(Geometry, CornersAreCarriedThroughStepsAndGrossErrors) {
    constexpr std::uint32_t kSeed = 7;
    std::printf("seed %u\n", kSeed);
    std::mt19937 random(kSeed);
    std::uniform_real_distribution<float> anywhere(0.0f, 1000.0f);
    const auto lit = [](double x, double y) {
        const double w = 1.0 + 2e-4 * x - 1e-4 * y;
        return glm::dvec2((0.71 * x + 0.06 * y + 30.0) / w, (-0.05 * x + 0.68 * y + 90.0) / w);
    };
    ImageF map(200, 160, 2);
    for (int y = 0; y < map.height; ++y)
        for (int x = 0; x < map.width; ++x) {
            const glm::dvec2 place = lit(x + 0.5, y + 0.5);
            map.at(x, y, 0) = static_cast<float>(std::floor(place.x) + 0.5);
            map.at(x, y, 1) = static_cast<float>(std::floor(place.y) + 0.5);
            if (anywhere(random) < 200.0f) {
                map.at(x, y, 0) = anywhere(random);
                map.at(x, y, 1) = anywhere(random);
            }
        }
    for (int y = 0; y < map.height; ++y)
        for (int x = 150; x < map.width; ++x) map.at(x, y, 0) = std::nanf("");
    const std::vector<glm::dvec2> corners = {{60.3, 70.8}, {100.0, 40.0}, {180.0, 80.0}};
    const auto carried = carry_corners(map, corners, 30.0);
    for (std::size_t k = 0; k < 2; ++k) {
        ASSERT_TRUE(carried[k].has_value());
        EXPECT_LT(glm::distance(*carried[k], lit(corners[k].x, corners[k].y)), 0.1);
    }
    EXPECT_FALSE(carried[2].has_value());
}

std::vector<BoardSight> real_sights(const std::filesystem::path& data) {
    std::vector<BoardSight> sights;
    for (int pose = 0; pose < 4; ++pose) {
        std::vector<Image8> pictures;
        for (int i = 0; i < 42; ++i) {
            char name[48];
            std::snprintf(name, sizeof(name), "procam/capture_%d/graycode_%02d.png", pose, i);
            const ImageFile file = read_image(data / name);
            Image8 one(file.image.width, file.image.height, 1);
            for (std::size_t k = 0; k < one.values.size(); ++k)
                one.values[k] = static_cast<std::uint8_t>(
                    file.image.values[k * static_cast<std::size_t>(file.image.channels)]);
            pictures.push_back(std::move(one));
        }
        const cv::Mat white(
            pictures[40].height, pictures[40].width, CV_8UC1, pictures[40].values.data());
        std::vector<cv::Point2f> corners;
        if (!cv::findChessboardCorners(white, cv::Size(9, 7), corners))
            throw std::runtime_error("no board found");
        cv::cornerSubPix(white, corners, {7, 7}, {-1, -1}, {3, 50, 1e-4});
        BoardSight sight;
        sight.board_mm = board_points_mm();
        for (const auto& c : corners) sight.camera_px.emplace_back(c.x + 0.5, c.y + 0.5);
        const auto decoded = decode_gray_code(std::span<const Image8>(pictures), 1024, 768);
        for (const auto& place : carry_corners(decoded.projector_px, sight.camera_px, 30.0)) {
            if (!place) throw std::runtime_error("a corner that cannot be carried");
            sight.projector_px.push_back(*place);
        }
        sights.push_back(sight);
    }
    return sights;
}

/// RMS of the pose left out; OpenCV alone. Both lenses and the pose between refined together, or,
/// `fixed`, the pose alone, between lenses that were fitted each by itself.
double opencv_held_out(const std::vector<BoardSight>& sights,
                       std::size_t out,
                       int flags,
                       bool fixed) {
    std::vector<std::vector<cv::Point3f>> boards;
    std::vector<std::vector<cv::Point2f>> seen, lit;
    for (const BoardSight& sight : sights) {
        boards.emplace_back();
        seen.emplace_back();
        lit.emplace_back();
        for (std::size_t k = 0; k < sight.board_mm.size(); ++k) {
            const auto point = [](glm::dvec2 p) {
                return cv::Point2f(float(p.x - 0.5), float(p.y - 0.5));
            };
            boards.back().emplace_back(float(sight.board_mm[k].x), float(sight.board_mm[k].y), 0.f);
            seen.back().push_back(point(sight.camera_px[k]));
            lit.back().push_back(point(sight.projector_px[k]));
        }
    }
    const auto left_board = boards[out];
    const auto left_seen = seen[out], left_lit = lit[out];
    const auto at = static_cast<std::ptrdiff_t>(out);
    boards.erase(boards.begin() + at);
    seen.erase(seen.begin() + at);
    lit.erase(lit.begin() + at);
    cv::Mat kc, dc, kp, dp, r, t, e, f;
    std::vector<cv::Mat> rs, ts;
    cv::calibrateCamera(boards, seen, {1280, 1024}, kc, dc, rs, ts, flags);
    cv::calibrateCamera(boards, lit, {1024, 768}, kp, dp, rs, ts, flags);
    cv::stereoCalibrate(boards,
                        seen,
                        lit,
                        kc,
                        dc,
                        kp,
                        dp,
                        {1280, 1024},
                        r,
                        t,
                        e,
                        f,
                        flags | (fixed ? cv::CALIB_FIX_INTRINSIC : cv::CALIB_USE_INTRINSIC_GUESS),
                        {3, 300, 1e-9});
    cv::Mat turn, shift, both_turn, both_shift;
    cv::solvePnP(left_board, left_seen, kc, dc, turn, shift);
    cv::Mat stereo_turn;
    cv::Rodrigues(r, stereo_turn);
    cv::composeRT(turn, shift, stereo_turn, t, both_turn, both_shift);
    std::vector<cv::Point2f> places;
    cv::projectPoints(left_board, both_turn, both_shift, kp, dp, places);
    double squares = 0.0;
    for (std::size_t k = 0; k < places.size(); ++k) {
        const cv::Point2f off = places[k] - left_lit[k];
        squares += double(off.dot(off));
    }
    return std::sqrt(squares / double(places.size()));
}

TEST(Geometry, RealPhotographsForetellAPoseLeftOutAsWellAsOpenCV) {
    LIVERY_NEEDS_REFERENCE_DATA(data);
    const auto sights = real_sights(data);
    const int no_k3 = cv::CALIB_ZERO_TANGENT_DIST | cv::CALIB_FIX_K3;
    double best = 1e9;
    const std::vector<std::pair<const char*, int>> lenses = {
        {"all five", 0}, {"k1 k2", no_k3}, {"k1", no_k3 | cv::CALIB_FIX_K2}};
    for (const bool fixed : {true, false})
        for (const auto& [lens, flags] : lenses) {
            double squares = 0.0;
            std::string each;
            for (std::size_t out = 0; out < sights.size(); ++out) {
                const double rms = opencv_held_out(sights, out, flags, fixed);
                squares += rms * rms / double(sights.size());
                each += (each.empty() ? "" : ", ") + std::to_string(rms).substr(0, 5);
            }
            std::printf("    OpenCV, %s, %s: %.3f px (%s)\n",
                        lens,
                        fixed ? "fixed intrinsics" : "joint",
                        std::sqrt(squares),
                        each.c_str());
            best = std::min(best, std::sqrt(squares));
        }
    const CheckedPair own = solve_leaving_each_out(sights, kCamera, kProjector);
    std::printf(
        "held out: %.3f px, OpenCV's best %.3f px; focal %.0f +- %.0f, "
        "projector %.0f +- %.0f px\n",
        own.held_out_rms_px,
        best,
        own.solution.camera.focal_px.x,
        own.solution.camera_standard_error_px[0],
        own.solution.projector.focal_px.x,
        own.solution.projector_standard_error_px[0]);
    EXPECT_LE(own.held_out_rms_px, 1.05 * best);
    for (const double rms : own.held_out_px) {
        std::printf("left out: %.3f px\n", rms);
        EXPECT_LT(rms, 0.7);
    }
}

// Ctrl-C in the longest fit: the one of all poses, then those without each of them.
TEST(Geometry, AFitOfTwentyPosesStopsWhenAsked) {
    std::vector<glm::dvec3> turns;
    for (std::size_t k = 0; k < 20; ++k) {
        turns.push_back(kTurns[k % kTurns.size()] + 0.004 * glm::dvec3(double(k), 0, -double(k)));
    }
    const auto sights = board_sights(pair_truth(), turns, 0.1, 3);
    // Within the first fit of all, which reports nothing
    std::atomic<bool> stop = true;
    EXPECT_THROW(solve_pair(sights, kCamera, kProjector, nullptr, {nullptr, &stop}), Cancelled);
    // Within the fit without the second pose: neither is that finished nor another begun
    std::vector<std::string> stages;
    stop = false;
    const auto report = [&](double, std::string_view stage) {
        stages.emplace_back(stage);
        stop = stages.size() == 2;
    };
    EXPECT_THROW(solve_leaving_each_out(sights, kCamera, kProjector, {report, &stop}), Cancelled);
    EXPECT_EQ(
        stages,
        (std::vector<std::string>{"fitting without pose 1 of 20", "fitting without pose 2 of 20"}));
}

}  // namespace
}  // namespace livery
