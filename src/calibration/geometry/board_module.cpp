#include "calibration/geometry/board_module.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <vector>

#include <opencv2/calib3d.hpp>
#include <opencv2/core/utils/logger.hpp>
#include <opencv2/imgproc.hpp>

namespace livery {

namespace {

cv::Mat matrix_of(const GreyPicture& picture) {
    cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT);
    return {picture.height, picture.width, CV_8UC1, const_cast<unsigned char*>(picture.values)};
}

/// A third of the smallest distance of neighbours: no other corner is in the window.
int window_of(const std::vector<cv::Point2f>& corners, int columns) {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i + 1 < corners.size(); ++i) {
        if ((i + 1) % static_cast<std::size_t>(columns) != 0)
            least = std::min(least, cv::norm(corners[i + 1] - corners[i]));
    }
    return std::clamp(static_cast<int>(least / 3.0), 2, 15);
}

void refine(const cv::Mat& picture, std::vector<cv::Point2f>& corners, int reach) {
    cv::cornerSubPix(picture,
                     corners,
                     {reach, reach},
                     {-1, -1},
                     {cv::TermCriteria::COUNT + cv::TermCriteria::EPS, 50, 1e-4});
}

void write(const std::vector<cv::Point2f>& corners, float* to) {
    for (std::size_t i = 0; i < corners.size(); ++i) {
        to[2 * i] = corners[i].x;
        to[2 * i + 1] = corners[i].y;
    }
}

std::vector<cv::Point2f> points_of(const float* corners, int count) {
    std::vector<cv::Point2f> points;
    for (int k = 0; k < count; ++k) points.emplace_back(corners[2 * k], corners[2 * k + 1]);
    return points;
}

int find_chessboard(GreyPicture grey, int columns, int rows, float* corners) try {
    const cv::Mat picture = matrix_of(grey);
    const cv::Size size(columns, rows);
    std::vector<cv::Point2f> found;
    // Without the fast check a picture of noise takes half a minute.
    const bool plain = cv::findChessboardCorners(
        picture,
        size,
        found,
        cv::CALIB_CB_ADAPTIVE_THRESH | cv::CALIB_CB_NORMALIZE_IMAGE | cv::CALIB_CB_FAST_CHECK);
    // Slower, and finds what is dim, blurred or unevenly lit.
    if (!plain && !cv::findChessboardCornersSB(picture, size, found)) return 0;
    if (plain) refine(picture, found, window_of(found, columns));
    write(found, corners);
    return 1;
} catch (const std::exception&) {
    return -1;
}

int find_any_grid(GreyPicture grey, int* columns, int* rows) try {
    std::vector<cv::Point2f> found;
    cv::Mat grid;
    if (!cv::findChessboardCornersSB(matrix_of(grey), {3, 3}, found, cv::CALIB_CB_LARGER, grid))
        return 0;
    *columns = grid.cols;
    *rows = grid.rows;
    return 1;
} catch (const std::exception&) {
    return -1;
}

int refine_corners(GreyPicture grey, float* corners, int count, int reach) try {
    std::vector<cv::Point2f> points = points_of(corners, count);
    refine(matrix_of(grey), points, reach);
    write(points, corners);
    return 1;
} catch (const std::exception&) {
    return -1;
}

int edge_width(GreyPicture grey, int columns, int rows, const float* corners, float* width) try {
    const cv::Scalar measured = cv::estimateChessboardSharpness(
        matrix_of(grey), {columns, rows}, points_of(corners, columns * rows), 0.8f);
    *width = static_cast<float>(measured[0]);
    return 1;
} catch (const std::exception&) {
    return -1;
}

int find_quadrilaterals(GreyPicture grey, float* corners, int capacity) try {
    const cv::Mat picture = matrix_of(grey);
    const int longer = std::max(picture.cols, picture.rows);
    int count = 0;
    // Small markers show under a small window, the inside of large ones stays whole under a large.
    for (const int share : {200, 80, 32, 12}) {
        const int window = std::max(5, longer / share | 1);
        cv::Mat dark;
        cv::adaptiveThreshold(
            picture, dark, 255, cv::ADAPTIVE_THRESH_MEAN_C, cv::THRESH_BINARY_INV, window, 7);
        std::vector<std::vector<cv::Point>> contours;
        cv::findContours(dark, contours, cv::RETR_LIST, cv::CHAIN_APPROX_NONE);
        for (const std::vector<cv::Point>& contour : contours) {
            constexpr double kLeastSide_px = 8.0;
            if (static_cast<double>(contour.size()) < 4.0 * kLeastSide_px) continue;
            std::vector<cv::Point> four;
            cv::approxPolyDP(contour, four, 0.04 * static_cast<double>(contour.size()), true);
            if (four.size() != 4 || !cv::isContourConvex(four)) continue;
            if (cv::contourArea(four, true) < 0.0) std::swap(four[1], four[3]);
            double least = std::numeric_limits<double>::infinity();
            for (std::size_t k = 0; k < 4; ++k)
                least = std::min(least, cv::norm(four[k] - four[(k + 1) % 4]));
            if (least < kLeastSide_px || count == capacity) continue;
            std::vector<cv::Point2f> places(four.begin(), four.end());
            refine(picture, places, std::clamp(static_cast<int>(least / 14.0), 1, 5));
            write(places, corners + 8 * count);
            ++count;
        }
    }
    return count;
} catch (const std::exception&) {
    return -1;
}

}  // namespace

}  // namespace livery

extern "C" __attribute__((visibility("default"))) const livery::BoardTable* livery_board_table();

const livery::BoardTable* livery_board_table() {
    static constexpr livery::BoardTable table{livery::find_chessboard,
                                              livery::find_any_grid,
                                              livery::refine_corners,
                                              livery::edge_width,
                                              livery::find_quadrilaterals};
    return &table;
}
