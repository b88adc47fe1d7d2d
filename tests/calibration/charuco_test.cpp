// ChArUco boards: markers and layout beside OpenCV's, corners beside the truth, and boards to
// print.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <opencv2/aruco/charuco.hpp>

#include "calibration/geometry/board_sight.h"
#include "calibration/geometry/find_board.h"
#include "calibration/support/board_photographs.h"
#include "core/worst_error.h"

namespace livery {
namespace {

using testing::board_scene;
using testing::BoardScene;
using testing::charuco_board;
using testing::photographs_of;
using testing::search_board;

constexpr Board kCharucoBoard{9, 7, 75.0, BoardKind::charuco, 52.5};

/// The board from straight above, ten millimetres a pixel's third, one square of white around it.
Image8 picture_of(const Board& board, int px_per_square) {
    Image8 picture((board.columns + 3) * px_per_square, (board.rows + 3) * px_per_square, 1);
    const auto reflectance = charuco_board(board);
    const double mm = board.square_mm / px_per_square;
    for (int y = 0; y < picture.height; ++y)
        for (int x = 0; x < picture.width; ++x)
            picture.at(x, y) = static_cast<std::uint8_t>(
                250.0 * reflectance({(x + 0.5) * mm - 2.0 * board.square_mm,
                                     (y + 0.5) * mm - 2.0 * board.square_mm}));
    return picture;
}

#if CV_VERSION_MAJOR > 4 || CV_VERSION_MINOR >= 7

cv::Ptr<cv::aruco::Dictionary> dictionary() {
    return cv::makePtr<cv::aruco::Dictionary>(
        cv::aruco::getPredefinedDictionary(cv::aruco::DICT_ARUCO_ORIGINAL));
}

cv::Ptr<cv::aruco::CharucoBoard> layout_of(const Board& board) {
    return cv::makePtr<cv::aruco::CharucoBoard>(cv::Size(board.columns + 1, board.rows + 1),
                                                static_cast<float>(board.square_mm),
                                                static_cast<float>(board.marker_mm),
                                                *dictionary());
}

cv::Mat drawn_marker(int number) {
    cv::Mat drawn;
    cv::aruco::generateImageMarker(*dictionary(), number, 7, drawn, 1);
    return drawn;
}

cv::Mat drawn_board(const cv::aruco::CharucoBoard& layout, const cv::Size& size_px, int margin_px) {
    cv::Mat drawn;
    layout.generateImage(size_px, drawn, margin_px, 1);
    return drawn;
}

#else

cv::Ptr<cv::aruco::Dictionary> dictionary() {
    return cv::aruco::getPredefinedDictionary(cv::aruco::DICT_ARUCO_ORIGINAL);
}

cv::Ptr<cv::aruco::CharucoBoard> layout_of(const Board& board) {
    return cv::aruco::CharucoBoard::create(board.columns + 1,
                                           board.rows + 1,
                                           static_cast<float>(board.square_mm),
                                           static_cast<float>(board.marker_mm),
                                           dictionary());
}

cv::Mat drawn_marker(int number) {
    cv::Mat drawn;
    cv::aruco::drawMarker(dictionary(), number, 7, drawn, 1);
    return drawn;
}

cv::Mat drawn_board(cv::aruco::CharucoBoard& layout, const cv::Size& size_px, int margin_px) {
    cv::Mat drawn;
    layout.draw(size_px, drawn, margin_px, 1);
    return drawn;
}

#endif

TEST(Charuco, MarkersAreThoseOfTheArucoOriginalDictionary) {
    for (int number = 0; number < kMarkers; ++number) {
        const cv::Mat drawn = drawn_marker(number);
        const MarkerCells cells = marker_cells(number);
        for (int row = 0; row < 5; ++row)
            for (int column = 0; column < 5; ++column)
                ASSERT_EQ(cells[static_cast<std::size_t>(5 * row + column)],
                          drawn.at<unsigned char>(row + 1, column + 1) > 127)
                    << number;
    }
    EXPECT_THROW(marker_cells(kMarkers), std::invalid_argument);
    EXPECT_THROW(marker_cells(-1), std::invalid_argument);
}

TEST(Charuco, OpenCVReadsTheSameBoard) {
    for (const Board& board : {kCharucoBoard,
                               Board{4, 6, 40.0, BoardKind::charuco, 30.0},
                               Board{6, 5, 40.0, BoardKind::charuco, 24.0}}) {
        const Image8 picture = picture_of(board, 60);
        const cv::Mat image(picture.height,
                            picture.width,
                            CV_8UC1,
                            const_cast<unsigned char*>(picture.values.data()));
        const auto layout = layout_of(board);
        std::vector<std::vector<cv::Point2f>> markers;
        std::vector<int> numbers;
        cv::aruco::detectMarkers(image, dictionary(), markers, numbers);
        EXPECT_EQ(numbers.size(), markers_of(board).size());
        std::vector<cv::Point2f> theirs;
        std::vector<int> ids;
        cv::aruco::interpolateCornersCharuco(markers, numbers, image, layout, theirs, ids);
        EXPECT_EQ(ids.size(), static_cast<std::size_t>(board.columns * board.rows));

        // And what it draws is read as what we draw.
        const cv::Mat drawn = drawn_board(*layout, {picture.width, picture.height}, 60);
        Image8 its_own(drawn.cols, drawn.rows, 1);
        std::copy(drawn.begin<unsigned char>(), drawn.end<unsigned char>(), its_own.values.begin());
        const auto of_its_own = find_charuco(its_own, board);
        ASSERT_FALSE(of_its_own.empty());

        const auto ours = find_charuco(picture, board);
        for (std::size_t k = 0; k < ids.size(); ++k) {
            const auto& own = ours.at(static_cast<std::size_t>(ids[k]));
            const auto& drawn_own = of_its_own.at(static_cast<std::size_t>(ids[k]));
            ASSERT_TRUE(own && drawn_own) << ids[k];
            EXPECT_LT(glm::distance(*own, *drawn_own), 0.6);  // it draws to whole pixels
            // The same corner: theirs lies up to half a pixel off the truth here.
            EXPECT_NEAR(own->x, theirs[k].x + 0.5, 1.0);
            EXPECT_NEAR(own->y, theirs[k].y + 0.5, 1.0);
            // Corner k of a board from straight above.
            EXPECT_NEAR(own->x, 60.0 * (2 + ids[k] % board.columns), 0.1);
            EXPECT_NEAR(own->y, 60.0 * (2 + ids[k] / board.columns), 0.1);
        }
    }
}

TEST(Charuco, MarkersAreReadHoweverTheyLie) {
    const Image8 picture = picture_of(kCharucoBoard, 40);
    for (int turns = 0; turns < 4; ++turns) {
        Image8 turned(turns % 2 ? picture.height : picture.width,
                      turns % 2 ? picture.width : picture.height,
                      1);
        for (int y = 0; y < picture.height; ++y)
            for (int x = 0; x < picture.width; ++x) {
                const int right = picture.width - 1 - x, bottom = picture.height - 1 - y;
                const glm::ivec2 to[] = {{x, y}, {bottom, x}, {right, bottom}, {y, right}};
                turned.at(to[turns].x, to[turns].y) = picture.at(x, y);
            }
        const auto corners = find_charuco(turned, kCharucoBoard);
        ASSERT_EQ(corners.size(), 63u) << turns;
        for (const auto& corner : corners) EXPECT_TRUE(corner) << turns;
        // The first corner, from the upper left as it was.
        const double w = picture.width, h = picture.height;
        const glm::dvec2 first[] = {{80, 80}, {h - 80, 80}, {w - 80, h - 80}, {80, w - 80}};
        EXPECT_LT(glm::distance(*corners[0], first[turns]), 0.2) << turns;
    }
}

/// The largest distance of the corners from where they are, camera pixels.
double worst_error(const BoardScene& scene, const BoardSight& sight) {
    double worst = 0.0;
    for (std::size_t k = 0; k < sight.board_mm.size(); ++k) {
        const auto seen =
            project(scene.camera, scene.camera_from_board * glm::dvec3(sight.board_mm[k], 0.0));
        worst = worse_of(worst, glm::distance(*seen, sight.camera_px[k]));
    }
    return worst;
}

/// Cells of markers are four pixels and more.
BoardScene charuco_scene(const glm::dvec3& turn) {
    BoardScene scene = board_scene(turn);
    scene.reflectance = charuco_board(kCharucoBoard);
    return scene;
}

// As for chessboards: .2 px.
TEST(Charuco, HalfHiddenBoardsAreUsable) {
    for (const glm::dvec3& turn : {glm::dvec3(0.3, 0.1, 0), glm::dvec3(-0.3, 0.4, 3.0)}) {
        BoardScene scene = charuco_scene(turn);
        const SightSearch all = search_board(photographs_of(scene), kCharucoBoard);
        ASSERT_TRUE(all.sight) << all.reason;
        EXPECT_EQ(all.corners, 63u);
        const double whole_px = worst_error(scene, *all.sight);
        scene.before = [](glm::dvec2 p) { return p.x > 330.0 ? 0.1 : -1.0; };
        const SightSearch half = search_board(photographs_of(scene), kCharucoBoard);
        ASSERT_TRUE(half.sight) << half.reason;
        EXPECT_GE(half.corners, 20u);
        EXPECT_LE(half.corners, 40u);
        const double half_px = worst_error(scene, *half.sight);
        std::printf("    worst corner: whole %.3f px, half hidden (%zu corners) %.3f px\n",
                    whole_px,
                    half.corners,
                    half_px);
        EXPECT_LT(whole_px, 0.2);
        EXPECT_LT(half_px, 0.2);
    }
}

TEST(Charuco, WhatIsMissingIsNamed) {
    const auto reason_of = [](const BoardScene& scene, const Board& board = kCharucoBoard) {
        const SightSearch found = search_board(photographs_of(scene), board);
        EXPECT_FALSE(found.sight.has_value());
        std::printf("    %s\n", found.reason.c_str());
        return found.reason;
    };
    BoardScene hidden = charuco_scene({0.3, 0.1, 0});
    hidden.before = [](glm::dvec2 p) { return p.x > 210.0 || p.y > 240.0 ? 0.1 : -1.0; };
    EXPECT_NE(reason_of(hidden).find("corners lie between two markers that can be read"),
              std::string::npos);
    BoardScene plain = charuco_scene({0.3, 0.1, 0});
    plain.reflectance = testing::chessboard(9, 7, 75.0);
    EXPECT_NE(reason_of(plain).find("without markers"), std::string::npos);
    BoardScene none = charuco_scene({0.3, 0.1, 0});
    none.reflectance = [](glm::dvec2 p) { return p.x > 100.0 ? 0.6 : 0.3; };
    EXPECT_NE(reason_of(none).find("no ChArUco board of 9x7 inner corners"), std::string::npos);
}

TEST(Charuco, BoardsThatCannotBeAreRefused) {
    const Image8 grey(64, 64, 1, 90);
    EXPECT_THROW(find_charuco(grey, Board{9, 7, 75.0}), std::invalid_argument);
    for (const Board& wrong : {Board{9, 7, 75.0, BoardKind::charuco, 75.0},
                               Board{9, 7, 75.0, BoardKind::charuco, 5.0},
                               Board{60, 60, 75.0, BoardKind::charuco, 50.0},
                               Board{9, 7, std::nan(""), BoardKind::chessboard, 0.0},
                               Board{2, 7, 75.0}})
        EXPECT_THROW(check_board(wrong), std::invalid_argument);
    EXPECT_TRUE(find_charuco(grey, kCharucoBoard).empty());
}

}  // namespace
}  // namespace livery
