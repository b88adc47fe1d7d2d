// What livery_boards.so offers: the only code that links OpenCV's calib3d and what comes with it.
// calibration/geometry/find_board.cpp opens it for the first board. Only plain data crosses this
// line; an exception never does.
#pragma once

namespace livery {

struct BoardTable {
    /// Inner corners of a chessboard, row by row, x and y of each (pixel centres at integers), into
    /// `corners`, which holds 2 * columns * rows numbers. 1: found; 0: not; -1: OpenCV failed.
    int (*find_chessboard)(
        const unsigned char* grey, int width, int height, int columns, int rows, float* corners);
};

inline constexpr const char* kBoardTableSymbol = "livery_board_table";

}  // namespace livery
