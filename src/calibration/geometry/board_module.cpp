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

/// A third of the smallest distance of neighbours: no other corner is in the window.
int window_of(const std::vector<cv::Point2f>& corners, int columns) {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i + 1 < corners.size(); ++i) {
        if ((i + 1) % static_cast<std::size_t>(columns) != 0)
            least = std::min(least, cv::norm(corners[i + 1] - corners[i]));
    }
    return std::clamp(static_cast<int>(least / 3.0), 2, 15);
}

int find_chessboard(
    const unsigned char* grey, int width, int height, int columns, int rows, float* corners) try {
    cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT);
    const cv::Mat picture(height, width, CV_8UC1, const_cast<unsigned char*>(grey));
    const cv::Size size(columns, rows);
    std::vector<cv::Point2f> found;
    const bool plain = cv::findChessboardCorners(picture, size, found);
    // Slower, and finds what is dim, blurred or unevenly lit.
    if (!plain && !cv::findChessboardCornersSB(picture, size, found)) return 0;
    if (plain) {
        const int window = window_of(found, columns);
        cv::cornerSubPix(picture,
                         found,
                         {window, window},
                         {-1, -1},
                         {cv::TermCriteria::COUNT + cv::TermCriteria::EPS, 50, 1e-4});
    }
    for (std::size_t i = 0; i < found.size(); ++i) {
        corners[2 * i] = found[i].x;
        corners[2 * i + 1] = found[i].y;
    }
    return 1;
} catch (const std::exception&) {
    return -1;
}

}  // namespace

}  // namespace livery

extern "C" __attribute__((visibility("default"))) const livery::BoardTable* livery_board_table();

const livery::BoardTable* livery_board_table() {
    static constexpr livery::BoardTable table{livery::find_chessboard};
    return &table;
}
