#include "cli/board_options.h"

#include <cmath>
#include <cstdio>

#include <fmt/format.h>

#include "core/error.h"

namespace livery {

namespace {

constexpr double kMarkerShare = 0.7;
constexpr const char* kCharuco = "charuco:";

}  // namespace

std::vector<Option> board_options(BoardArguments& arguments, bool required) {
    return {{"--board",
             "[charuco:]WxH",
             "inner corners of a chessboard or a ChArUco board",
             &arguments.board,
             required,
             {}},
            {"--square-mm", "MM", "side of a square", &arguments.square_mm, required, {}},
            {"--marker-mm",
             "MM",
             "side of a ChArUco board's markers (default: 0.7 of a square)",
             &arguments.marker_mm,
             false,
             {}}};
}

Board parse_board(const BoardArguments& arguments) {
    Board board;
    std::string size = arguments.board;
    if (size.starts_with(kCharuco)) {
        board.kind = BoardKind::charuco;
        size.erase(0, std::string(kCharuco).size());
    }
    char end = 0;
    const bool whole =
        std::sscanf(size.c_str(), "%3dx%3d%c", &board.columns, &board.rows, &end) == 2;
    if (!whole || board.columns < 3 || board.rows < 3 || board.columns > 100 || board.rows > 100)
        throw std::invalid_argument(
            fmt::format("--board: found \"{}\", expected COLUMNSxROWS of inner corners, 3 to 100 "
                        "each, or charuco:COLUMNSxROWS",
                        arguments.board));
    board.square_mm = arguments.square_mm;
    check_argument(std::isfinite(board.square_mm) && board.square_mm > 0.0,
                   fmt::format("--square-mm: found {}, expected more than 0", board.square_mm));
    check_argument(std::isfinite(arguments.marker_mm) && arguments.marker_mm >= 0.0 &&
                       (arguments.marker_mm == 0.0 || board.kind == BoardKind::charuco),
                   fmt::format("--marker-mm: found {}, expected more than 0, and a board of "
                               "charuco:COLUMNSxROWS",
                               arguments.marker_mm));
    if (board.kind == BoardKind::charuco)
        board.marker_mm =
            arguments.marker_mm > 0.0 ? arguments.marker_mm : kMarkerShare * board.square_mm;
    check_board(board);
    return board;
}

}  // namespace livery
