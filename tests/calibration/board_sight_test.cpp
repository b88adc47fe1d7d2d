// Boards in photographs: found where they are, and what spoils them named with the way out.
#include "calibration/geometry/board_sight.h"

#include <algorithm>
#include <cstdio>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "calibration/geometry/find_board.h"
#include "calibration/support/board_photographs.h"
#include "core/error.h"
#include "core/worst_error.h"

namespace livery {
namespace {

using testing::board_scene;
using testing::BoardScene;
using testing::chessboard;
using testing::photographs_of;
using testing::search_board;

constexpr Board kChessboard{9, 7, 75.0};

/// What is said of a pose that cannot be used.
std::string reason_of(const std::vector<RoledPhotograph>& photographs,
                      const Board& board = kChessboard) {
    const SightSearch found = search_board(photographs, board);
    EXPECT_FALSE(found.sight.has_value());
    std::printf("    %s\n", found.reason.c_str());
    return found.reason;
}

bool holds(const std::string& text, const char* part) {
    return text.find(part) != std::string::npos;
}

void blur(ImageF& image, double sigma_px) {
    cv::Mat picture(image.height, image.width, CV_32FC1, image.values.data());
    cv::GaussianBlur(picture, picture, {0, 0}, sigma_px);
}

/// The largest distance of the corners from where they are, camera and projector pixels. The board
/// may be numbered from its other end.
std::pair<double, double> worst_errors(const BoardScene& scene, const BoardSight& sight) {
    std::pair<double, double> least(1e9, 1e9);
    for (const bool turned : {false, true}) {
        std::pair<double, double> worst(0.0, 0.0);
        for (std::size_t k = 0; k < sight.board_mm.size(); ++k) {
            const glm::dvec2 p =
                turned ? glm::dvec2(600, 450) - sight.board_mm[k] : sight.board_mm[k];
            const glm::dvec3 place = scene.camera_from_board * glm::dvec3(p, 0.0);
            worst.first = worse_of(
                worst.first, glm::distance(*project(scene.camera, place), sight.camera_px[k]));
            worst.second =
                worse_of(worst.second,
                         glm::distance(*project(scene.projector, place), sight.projector_px[k]));
        }
        if (worst.first < least.first) least = worst;
    }
    return least;
}

// Corners of noise .002 on edges of .7 lie within hundredths of a pixel; .2 leaves room for edges
// drawn to a sixteenth, which favour a side together. In the projector, the sides of whole pixels
// carry them: a third of a pixel.
TEST(BoardSight, CornersAreWhereTheBoardsAre) {
    for (const glm::dvec3& turn : {glm::dvec3(0.0),
                                   glm::dvec3(0.5, 0, 0),
                                   glm::dvec3(0, -0.5, 0.1),
                                   glm::dvec3(0, 0, 3.1)}) {
        const BoardScene scene = board_scene(turn);
        const SightSearch found = search_board(photographs_of(scene), kChessboard);
        ASSERT_TRUE(found.sight) << found.reason;
        EXPECT_EQ(found.corners, 63u);
        const auto [camera_px, projector_px] = worst_errors(scene, *found.sight);
        std::printf(
            "    worst corner: camera %.3f px, projector %.3f px; edges %.1f px, moved "
            "%.3f px\n",
            camera_px,
            projector_px,
            found.edge_px,
            found.moved_px);
        EXPECT_LT(camera_px, 0.2);
        EXPECT_LT(projector_px, 0.33);
        EXPECT_LT(found.moved_px, 0.1);
    }
}

TEST(BoardSight, AHalfHiddenBoardSaysHowMuchOfItIsSeen) {
    BoardScene scene = board_scene({0.3, 0.1, 0});
    scene.before = [](glm::dvec2 p) { return p.x > 330.0 ? 0.1 : -1.0; };
    const std::string reason = reason_of(photographs_of(scene));
    EXPECT_TRUE(holds(reason, "of the board's 9x7 inner corners are seen"));
    EXPECT_TRUE(holds(reason, "all of it must be seen"));
}

TEST(BoardSight, AnotherBoardSaysHowManyCornersItHas) {
    BoardScene scene = board_scene({0.3, 0.1, 0});
    scene.reflectance = chessboard(11, 6, 60.0);
    const std::string reason = reason_of(photographs_of(scene));
    EXPECT_TRUE(holds(reason, "has 11x6 inner corners, not 9x7"));
    EXPECT_TRUE(holds(reason, "give its corners, not its squares"));
}

TEST(BoardSight, NoBoardAtAll) {
    BoardScene scene = board_scene({0.3, 0.1, 0});
    // A wall with a sharp border, so that it is not out of focus either.
    scene.reflectance = [](glm::dvec2 p) { return p.x > 100.0 ? 0.6 : 0.3; };
    EXPECT_TRUE(holds(reason_of(photographs_of(scene)), "no board of 9x7 inner corners"));
}

// From edges as wide as a third of a square on; a board blurred beyond finding is told by the
// picture's sharpest edges.
TEST(BoardSight, BlurIsNamed) {
    for (const double sigma : {7.0, 25.0}) {
        auto photographs = photographs_of(board_scene({0.3, 0.1, 0}));
        const auto decoded = decode_gray_code(photographs, 256, 192);
        for (RoledPhotograph& one : photographs) blur(one.photograph.image, sigma);
        const SightSearch found = search_sight(photographs, decoded.projector_px, kChessboard);
        std::printf("    %s\n", found.reason.c_str());
        EXPECT_FALSE(found.sight.has_value());
        EXPECT_TRUE(holds(found.reason, "blurred")) << sigma;
        EXPECT_TRUE(holds(found.reason, "focus the camera")) << sigma;
    }
    auto photographs = photographs_of(board_scene({0.3, 0.1, 0}));
    for (RoledPhotograph& one : photographs) blur(one.photograph.image, 1.5);
    EXPECT_TRUE(search_board(photographs, kChessboard).sight.has_value());
}

TEST(BoardSight, EdgesOfKnownWidthAreMeasured) {
    Image8 edge(200, 100, 1);
    for (const double sigma : {2.0, 6.0}) {
        for (int y = 0; y < edge.height; ++y)
            for (int x = 0; x < edge.width; ++x)
                edge.at(x, y) = static_cast<std::uint8_t>(
                    std::lround(127.5 * (1.0 + std::erf((x - 100.0) / (sigma * std::sqrt(2.0))))));
        // 2 pi sigma^2, rooted: the span over the steepest gradient.
        EXPECT_NEAR(sharpest_edge_px(edge, 40), 2.507 * sigma, 0.1 * 2.507 * sigma);
    }
    EXPECT_EQ(sharpest_edge_px(Image8(50, 50, 1, 90), 10), 0.0);
}

// By a little, by more than the corners' window, and at the end only.
TEST(BoardSight, ABoardThatMovedDuringTheCodeIsNamed) {
    const auto still = photographs_of(board_scene({0.3, 0.1, 0}));
    for (const double away_mm : {2.0, 40.0}) {
        const auto after = photographs_of(board_scene({0.3, 0.1, 0}, {away_mm, 0.0, 2000.0}));
        auto mixed = still;
        for (std::size_t k = 0; k < mixed.size(); ++k)
            if (mixed[k].role != "white" && mixed[k].role != "black") mixed[k] = after[k];
        const auto decoded = decode_gray_code(mixed, 256, 192);
        const SightSearch found = search_sight(mixed, decoded.projector_px, kChessboard);
        std::printf("    %s\n", found.reason.c_str());
        EXPECT_TRUE(holds(found.reason, "px elsewhere in gray-")) << away_mm;
        EXPECT_TRUE(holds(found.reason, "photograph the pose again")) << away_mm;
        if (away_mm < 10.0) {
            EXPECT_NEAR(found.moved_px, 1200.0 * away_mm / 2000.0, 0.2);
        }
    }
    auto last = still;
    const auto after = photographs_of(board_scene({0.3, 0.1, 0}, {5.0, 0.0, 2000.0}));
    for (std::size_t k = 0; k < last.size(); ++k)
        if (last[k].role.starts_with("gray-row-7")) last[k] = after[k];
    EXPECT_TRUE(holds(reason_of(last), "elsewhere in gray-row-7 than in white"));
}

TEST(BoardSight, TooFewCornersUnderTheCodeAreCounted) {
    BoardScene scene = board_scene({0.3, 0.1, 0});
    // Zoomed in: it lights a third of the board, the room the rest.
    scene.projector.focal_px *= 3.0;
    scene.projector.principal_px = {40, 500};
    scene.ambient = 0.3;
    const std::string reason = reason_of(photographs_of(scene));
    EXPECT_TRUE(holds(reason, "corners lie where the Gray code could be decoded"));
    EXPECT_TRUE(holds(reason, "the projector must light the whole board"));
}

TEST(BoardSight, AMirroredPictureIsNamed) {
    auto photographs = photographs_of(board_scene({0.3, 0.1, 0}));
    for (RoledPhotograph& one : photographs) {
        ImageF& image = one.photograph.image;
        for (int y = 0; y < image.height; ++y)
            std::reverse(image.pixel(0, y), image.pixel(0, y) + image.width);
    }
    EXPECT_TRUE(holds(reason_of(photographs), "mirrored to each other"));
}

TEST(BoardSight, WhatIsNoSetOfPhotographsIsRefused) {
    const ImageF map(64, 64, 2);
    EXPECT_THROW(search_sight({}, map, kChessboard), FileError);
    RoledPhotograph white{"white", {}};
    white.photograph.image = ImageF(64, 64, 1, 0.5f);
    EXPECT_THROW(search_sight({white}, map, Board{2, 7, 75.0}), std::invalid_argument);
}

}  // namespace
}  // namespace livery
