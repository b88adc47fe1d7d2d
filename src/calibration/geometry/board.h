// Flat boards that lenses are calibrated with: where their corners and markers lie, and a board to
// print, in true size.
#pragma once

#include <bitset>
#include <string>
#include <string_view>
#include <vector>

#include <glm/vec2.hpp>

namespace livery {

enum class BoardKind {
    chessboard,
    charuco,  ///< with a marker in each white square: corners are known by themselves
};

/// By its inner corners. The board's frame: x along the rows, y down, from the first inner corner;
/// the square left of and above it is dark.
struct Board {
    int columns = 0, rows = 0;
    double square_mm = 0.0;
    BoardKind kind = BoardKind::chessboard;
    double marker_mm = 0.0;  ///< side of a ChArUco board's markers
};

/// "charuco 9x7".
std::string name_of(const Board& board);

/// Throws std::invalid_argument: fewer than 3 x 3 or more than 100 x 100 corners, squares that are
/// not 1 to 1000 mm, markers that are not 0.3 to 0.9 of them, more markers than there are.
void check_board(const Board& board);

/// Inner corners, row by row, in the board's frame.
std::vector<glm::dvec2> corners_mm(const Board& board);

/// 5 x 5 cells in rows from the upper left, 1 is white; around them goes a dark border of one cell.
using MarkerCells = std::bitset<25>;

/// Markers of the ArUco original dictionary, numbers 0 to 1022 (1023 looks alike when turned
/// round): two bits of the number a row, each pair as a word of five cells (Munoz-Salinas and
/// Garrido-Jurado, ArUco, 2012).
inline constexpr int kMarkers = 1023;
MarkerCells marker_cells(int number);

struct BoardMarker {
    int number = 0;
    glm::dvec2 middle_mm{0.0};
};

/// Markers of a ChArUco board: the white squares row by row, from the upper left (OpenCV's layout
/// up to version 4.6).
std::vector<BoardMarker> markers_of(const Board& board);

struct PaperSize {
    std::string name;
    double width_mm = 0.0, height_mm = 0.0;  ///< upright
};

/// A0 to A4, letter, legal, tabloid, in any case. Throws std::invalid_argument that lists them.
PaperSize paper_of(std::string_view name);

/// Reflectance (sRGB value 0 to 1) of what is dark: not black, since stripes are read on it.
inline constexpr double kBoardInk = 0.4;

/// The page as an SVG or a PDF (1.4) file: the board in the middle, its name and sizes, and a line
/// of 100 mm to check the print by. Turned where the board is wider than high. The same input gives
/// the same bytes. Throws std::invalid_argument as check_board(), and where the board with a white
/// border of half a square does not fit; the message says the largest square that does.
std::string board_svg(const Board& board, const PaperSize& paper);
std::string board_pdf(const Board& board, const PaperSize& paper);

}  // namespace livery
