// What livery_boards.so offers: the only code that links OpenCV's calib3d and what comes with it.
// calibration/geometry/find_board.cpp opens it for the first board. Only plain data crosses this
// line; an exception never does.
#pragma once

namespace livery {

/// One channel, rows go down. In what the functions below return, pixel centres are at integers.
struct GreyPicture {
    const unsigned char* values;
    int width, height;
};

/// All return -1 where OpenCV failed.
struct BoardTable {
    /// Inner corners of a chessboard, row by row, x and y of each, into `corners`, which holds
    /// 2 * columns * rows numbers. 1: found; 0: not.
    int (*find_chessboard)(GreyPicture picture, int columns, int rows, float* corners);
    /// The largest grid of 3 x 3 corners or more. 1: found; 0: not.
    int (*find_any_grid)(GreyPicture picture, int* columns, int* rows);
    /// Moves corners to where the gradients around each meet, within a window of 2 * reach + 1.
    int (*refine_corners)(GreyPicture picture, float* corners, int count, int reach);
    /// Mean width of the edges between the squares of a chessboard that was found, 10% to 90%.
    int (*edge_width)(
        GreyPicture picture, int columns, int rows, const float* corners, float* width);
    /// Dark quadrilaterals on brighter ground, clockwise, four corners each, into `corners`, which
    /// holds 8 * capacity numbers. How many there are, at most `capacity`.
    int (*find_quadrilaterals)(GreyPicture picture, float* corners, int capacity);
};

inline constexpr const char* kBoardTableSymbol = "livery_board_table";

}  // namespace livery
