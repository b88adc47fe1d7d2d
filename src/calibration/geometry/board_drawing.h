// A board to print, in true size.
#pragma once

#include <string>
#include <string_view>

#include "calibration/geometry/board.h"

namespace livery {

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
