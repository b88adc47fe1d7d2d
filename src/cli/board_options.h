// Boards as the command line names them.
#pragma once

#include <string>
#include <vector>

#include "calibration/geometry/board.h"
#include "cli/command.h"

namespace livery {

struct BoardArguments {
    std::string board;
    double square_mm = 0.0;
    double marker_mm = 0.0;  ///< 0: seven tenths of a square
};

/// --board, --square-mm, --marker-mm.
std::vector<Option> board_options(BoardArguments& arguments, bool required);

/// "9x7" or "charuco:9x7": columns and rows of inner corners. Throws std::invalid_argument.
Board parse_board(const BoardArguments& arguments);

}  // namespace livery
