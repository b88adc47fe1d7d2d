#include "calibration/geometry/board.h"

#include <array>
#include <cmath>

#include <fmt/format.h>

#include "core/error.h"

namespace livery {

std::string name_of(const Board& board) {
    return fmt::format("{} {}x{}",
                       board.kind == BoardKind::charuco ? "charuco" : "chessboard",
                       board.columns,
                       board.rows);
}

void check_board(const Board& board) {
    check_argument(
        board.columns >= 3 && board.rows >= 3 && board.columns <= 100 && board.rows <= 100,
        fmt::format(
            "a board of {}x{} inner corners, expected 3x3 to 100x100", board.columns, board.rows));
    check_argument(
        std::isfinite(board.square_mm) && board.square_mm >= 1.0 && board.square_mm <= 1000.0,
        fmt::format("squares of {} mm (--square-mm), expected 1 to 1000", board.square_mm));
    if (board.kind != BoardKind::charuco) return;
    const double share = board.marker_mm / board.square_mm;
    check_argument(share >= 0.3 && share <= 0.9,
                   fmt::format("markers of {} mm (--marker-mm), expected 0.3 to 0.9 of a square, "
                               "{:.1f} to {:.1f}",
                               board.marker_mm,
                               0.3 * board.square_mm,
                               0.9 * board.square_mm));
    const int markers = (board.columns + 1) * (board.rows + 1) / 2;
    check_argument(markers <= kMarkers,
                   fmt::format("a ChArUco board of {}x{} inner corners has {} markers, expected at "
                               "most {}",
                               board.columns,
                               board.rows,
                               markers,
                               kMarkers));
}

std::vector<glm::dvec2> corners_mm(const Board& board) {
    std::vector<glm::dvec2> corners;
    for (int row = 0; row < board.rows; ++row)
        for (int column = 0; column < board.columns; ++column)
            corners.emplace_back(column * board.square_mm, row * board.square_mm);
    return corners;
}

MarkerCells marker_cells(int number) {
    check_argument(number >= 0 && number < kMarkers,
                   fmt::format("marker {}, expected 0 to {}", number, kMarkers - 1));
    constexpr std::array<const char*, 4> kWords = {"10000", "10111", "01001", "01110"};
    MarkerCells cells;
    for (std::size_t row = 0; row < 5; ++row) {
        const auto pair = static_cast<std::size_t>(number >> (8 - 2 * row)) & 3u;
        for (std::size_t column = 0; column < 5; ++column)
            cells[5 * row + column] = kWords[pair][column] == '1';
    }
    return cells;
}

std::vector<BoardMarker> markers_of(const Board& board) {
    std::vector<BoardMarker> markers;
    if (board.kind != BoardKind::charuco) return markers;
    for (int row = 0; row <= board.rows; ++row)
        for (int column = 0; column <= board.columns; ++column)
            if ((row + column) % 2 == 1)
                markers.push_back({static_cast<int>(markers.size()),
                                   board.square_mm * glm::dvec2(column - 0.5, row - 0.5)});
    return markers;
}

}  // namespace livery
