#include "calibration/geometry/find_board.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

#include "calibration/geometry/board_module.h"
#include "core/error.h"
#include "core/statistics.h"
#include "core/system/module.h"

namespace livery {

namespace {

const BoardTable& board_table() {
    static const BoardTable& table = *reinterpret_cast<const BoardTable* (*)()>(
        symbol_of_module("livery_boards.so", kBoardTableSymbol, "the module that finds boards"))();
    return table;
}

GreyPicture picture_of(const Image8& grey) {
    check_argument(grey.channels == 1 && !grey.empty(), "a board: one channel expected");
    return {grey.values.data(), grey.width, grey.height};
}

void check_size(int columns, int rows) {
    check_argument(
        columns >= 3 && rows >= 3 && columns <= 100 && rows <= 100,
        fmt::format("a board of {}x{} inner corners, expected 3x3 to 100x100", columns, rows));
}

std::vector<float> to_opencv(std::span<const glm::dvec2> corners) {
    std::vector<float> all;
    for (const glm::dvec2& one : corners) {
        all.push_back(static_cast<float>(one.x - 0.5));
        all.push_back(static_cast<float>(one.y - 0.5));
    }
    return all;
}

std::vector<glm::dvec2> from_opencv(const std::vector<float>& corners) {
    std::vector<glm::dvec2> all;
    for (std::size_t i = 0; i + 1 < corners.size(); i += 2)
        all.emplace_back(static_cast<double>(corners[i]) + 0.5,
                         static_cast<double>(corners[i + 1]) + 0.5);
    return all;
}

}  // namespace

Image8 grey_for_corners(const ImageF& picture) {
    check_argument(picture.channels == 1 && !picture.empty(), "a board: one channel expected");
    std::vector<float> thinned;
    for (std::size_t i = 0; i < picture.values.size(); i += 7) thinned.push_back(picture.values[i]);
    const float low = quantile(thinned, 0.01), high = quantile(thinned, 0.995);
    Image8 grey(picture.width, picture.height, 1);
    for (std::size_t i = 0; i < picture.values.size(); ++i) {
        const float share = (picture.values[i] - low) / std::max(high - low, 1e-20f);
        grey.values[i] = static_cast<std::uint8_t>(
            std::lround(255.0f * std::sqrt(std::clamp(share, 0.0f, 1.0f))));
    }
    return grey;
}

std::vector<glm::dvec2> find_board(const Image8& grey, int columns, int rows) {
    check_size(columns, rows);
    std::vector<float> corners(2 * static_cast<std::size_t>(columns * rows));
    const int found =
        board_table().find_chessboard(picture_of(grey), columns, rows, corners.data());
    if (found != 1) return {};
    return from_opencv(corners);
}

std::optional<glm::ivec2> find_any_grid(const Image8& grey) {
    glm::ivec2 size(0);
    if (board_table().find_any_grid(picture_of(grey), &size.x, &size.y) != 1) return std::nullopt;
    return size;
}

std::vector<glm::dvec2> refined_corners(const Image8& grey,
                                        std::span<const glm::dvec2> corners,
                                        int reach_px) {
    check_argument(reach_px >= 1 && reach_px <= 100, "corners are refined within 1 to 100 px");
    std::vector<float> places = to_opencv(corners);
    if (board_table().refine_corners(
            picture_of(grey), places.data(), static_cast<int>(corners.size()), reach_px) != 1)
        throw std::runtime_error("the board's corners could not be refined");
    return from_opencv(places);
}

std::vector<glm::dvec2> find_quadrilaterals(const Image8& grey) {
    // Each of a board's markers shows under four windows, inside and outside; the rest is clutter.
    constexpr int kMost = 20'000;
    std::vector<float> corners(8 * static_cast<std::size_t>(kMost));
    const int count = board_table().find_quadrilaterals(picture_of(grey), corners.data(), kMost);
    corners.resize(8 * static_cast<std::size_t>(std::max(0, count)));
    return from_opencv(corners);
}

double edge_width_px(const Image8& grey,
                     int columns,
                     int rows,
                     std::span<const glm::dvec2> corners) {
    check_size(columns, rows);
    check_argument(corners.size() == static_cast<std::size_t>(columns * rows),
                   "edge_width_px: all corners of the board expected");
    float width = 0.0f;
    if (board_table().edge_width(
            picture_of(grey), columns, rows, to_opencv(corners).data(), &width) != 1)
        throw std::runtime_error("the width of the board's edges could not be measured");
    return static_cast<double>(width);
}

}  // namespace livery
