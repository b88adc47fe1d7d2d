#include "calibration/geometry/find_board.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "calibration/geometry/board_module.h"
#include "core/error.h"
#include "core/module.h"
#include "core/statistics.h"

namespace livery {

namespace {

const BoardTable& board_table() {
    static const BoardTable& table = *reinterpret_cast<const BoardTable* (*)()>(
        symbol_of_module("livery_boards.so", kBoardTableSymbol, "the module that finds boards"))();
    return table;
}

}  // namespace

std::vector<glm::dvec2> find_board(const ImageF& picture, int columns, int rows) {
    check_argument(
        columns >= 3 && rows >= 3 && columns <= 100 && rows <= 100,
        fmt::format("a board of {}x{} inner corners, expected 3x3 to 100x100", columns, rows));
    check_argument(picture.channels == 1 && !picture.empty(), "find_board: one channel expected");
    // To 8 bits between black and the bright end, by a square root: squares in the dark stay apart.
    std::vector<float> thinned;
    for (std::size_t i = 0; i < picture.values.size(); i += 7) thinned.push_back(picture.values[i]);
    const float low = quantile(thinned, 0.01), high = quantile(thinned, 0.995);
    Image8 grey(picture.width, picture.height, 1);
    for (std::size_t i = 0; i < picture.values.size(); ++i) {
        const float share = (picture.values[i] - low) / std::max(high - low, 1e-20f);
        grey.values[i] = static_cast<std::uint8_t>(
            std::lround(255.0f * std::sqrt(std::clamp(share, 0.0f, 1.0f))));
    }
    std::vector<float> corners(2 * static_cast<std::size_t>(columns * rows));
    const int found = board_table().find_chessboard(
        grey.values.data(), grey.width, grey.height, columns, rows, corners.data());
    std::vector<glm::dvec2> result;
    for (std::size_t i = 0; found == 1 && i + 1 < corners.size(); i += 2) {
        result.emplace_back(static_cast<double>(corners[i]) + 0.5,
                            static_cast<double>(corners[i + 1]) + 0.5);
    }
    return result;
}

}  // namespace livery
