#include "calibration/geometry/find_board.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "calibration/geometry/board_module.h"
#include "calibration/geometry/homography.h"
#include "core/error.h"
#include "core/statistics.h"
#include "core/system/module.h"
#include "core/worst_error.h"

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

namespace {

constexpr int kCells = 7;  ///< a side, with the border
constexpr std::size_t kLeastMarkers = 3;
/// Of a marker's side in the picture: what its corners may lie off the board's place.
constexpr double kAgreement = 0.35;

/// Corners of the cells' frame, as a quadrilateral names them.
std::array<glm::dvec2, 4> frame_corners(double side) {
    return {glm::dvec2(0.0), {side, 0.0}, {side, side}, {0.0, side}};
}

/// Mean brightness of each cell's middle, from the quadrilateral's first corner; empty where it
/// reaches out of the picture.
std::vector<double> cell_means(const Image8& grey, std::span<const glm::dvec2> corners_px) {
    const auto frame = frame_corners(kCells);
    const glm::dmat3 px_from_cell = homography_of(frame, corners_px);
    std::vector<double> means;
    for (int row = 0; row < kCells; ++row)
        for (int column = 0; column < kCells; ++column) {
            double sum = 0.0;
            for (const double v : {0.3, 0.5, 0.7})
                for (const double u : {0.3, 0.5, 0.7}) {
                    const glm::dvec2 place = mapped(px_from_cell, {column + u, row + v});
                    if (!(place.x >= 0.0 && place.y >= 0.0 && place.x < grey.width &&
                          place.y < grey.height))
                        return {};
                    sum += grey.at(static_cast<int>(place.x), static_cast<int>(place.y)) / 9.0;
                }
            means.push_back(sum);
        }
    return means;
}

/// The cells inside a dark border; nothing where the border is not dark.
std::optional<MarkerCells> cells_of(const std::vector<double>& means) {
    const auto [least, most] = std::minmax_element(means.begin(), means.end());
    if (*most - *least < 12.0) return std::nullopt;
    const double limit = 0.5 * (*least + *most);
    MarkerCells cells;
    for (int row = 0; row < kCells; ++row)
        for (int column = 0; column < kCells; ++column) {
            const bool white = means[static_cast<std::size_t>(kCells * row + column)] > limit;
            const bool border =
                row == 0 || column == 0 || row == kCells - 1 || column == kCells - 1;
            if (border && white) return std::nullopt;
            if (!border) cells[static_cast<std::size_t>(5 * (row - 1) + column - 1)] = white;
        }
    return cells;
}

/// Turned by a quarter: what was left is up.
MarkerCells turned(const MarkerCells& cells) {
    MarkerCells result;
    for (std::size_t row = 0; row < 5; ++row)
        for (std::size_t column = 0; column < 5; ++column)
            result[5 * row + column] = cells[5 * (4 - column) + row];
    return result;
}

struct PlacedMarker {
    const SeenMarker* seen = nullptr;
    std::array<glm::dvec2, 4> board_mm;  ///< its corners
    double side_px = 0.0;
};

glm::dmat3 px_from_board(const std::vector<const PlacedMarker*>& markers) {
    std::vector<glm::dvec2> from, to;
    for (const PlacedMarker* one : markers) {
        from.insert(from.end(), one->board_mm.begin(), one->board_mm.end());
        to.insert(to.end(), one->seen->corners_px.begin(), one->seen->corners_px.end());
    }
    return homography_of(from, to);
}

double worst_corner(const glm::dmat3& homography, const PlacedMarker& marker) {
    double worst = 0.0;
    for (std::size_t k = 0; k < 4; ++k)
        worst = worse_of(
            worst,
            glm::distance(mapped(homography, marker.board_mm[k]), marker.seen->corners_px[k]));
    return worst;
}

/// Grows from one marker: what lies where those so far have the board joins them.
std::vector<const PlacedMarker*> agreeing(const std::vector<PlacedMarker>& all,
                                          const PlacedMarker& first) {
    std::vector<const PlacedMarker*> joined{&first};
    for (int round = 0; round < 20; ++round) {
        const glm::dmat3 homography = px_from_board(joined);
        std::vector<const PlacedMarker*> next;
        for (const PlacedMarker& one : all)
            if (worst_corner(homography, one) < kAgreement * one.side_px) next.push_back(&one);
        if (next.empty()) return {};
        if (next == joined) break;
        joined = std::move(next);
    }
    return joined;
}

std::vector<PlacedMarker> placed_markers(const std::vector<SeenMarker>& seen, const Board& board) {
    const std::vector<BoardMarker> markers = markers_of(board);
    const double half = 0.5 * board.marker_mm;
    std::vector<PlacedMarker> all;
    for (const SeenMarker& one : seen) {
        const glm::dvec2 middle = markers[static_cast<std::size_t>(one.number)].middle_mm;
        double round_px = 0.0;
        for (std::size_t k = 0; k < 4; ++k)
            round_px += glm::distance(one.corners_px[k], one.corners_px[(k + 1) % 4]);
        all.push_back({&one,
                       {middle + glm::dvec2(-half, -half),
                        middle + glm::dvec2(half, -half),
                        middle + glm::dvec2(half, half),
                        middle + glm::dvec2(-half, half)},
                       0.25 * round_px});
    }
    return all;
}

}  // namespace

std::vector<SeenMarker> read_markers(const Image8& grey,
                                     std::span<const glm::dvec2> quadrilaterals_px,
                                     int count) {
    std::vector<SeenMarker> seen;
    for (std::size_t i = 0; i + 3 < quadrilaterals_px.size(); i += 4) {
        const auto corners = quadrilaterals_px.subspan(i, 4);
        const std::vector<double> means = cell_means(grey, corners);
        if (means.empty()) continue;
        auto cells = cells_of(means);
        for (std::size_t turns = 0; cells && turns < 4; ++turns) {
            for (int number = 0; number < count; ++number) {
                if (marker_cells(number) != *cells) continue;
                // What is up after these turns was left of it: its first corner comes later.
                SeenMarker one{number, {}};
                for (std::size_t k = 0; k < 4; ++k)
                    one.corners_px.push_back(corners[(k + 4 - turns) % 4]);
                seen.push_back(std::move(one));
            }
            cells = turned(*cells);
        }
    }
    return seen;
}

std::vector<std::optional<glm::dvec2>> find_charuco(const Image8& grey, const Board& board) {
    check_board(board);
    check_argument(board.kind == BoardKind::charuco, "find_charuco: a ChArUco board expected");
    const int count = static_cast<int>(markers_of(board).size());
    const auto seen = read_markers(grey, find_quadrilaterals(grey), count);
    const std::vector<PlacedMarker> all = placed_markers(seen, board);
    std::vector<const PlacedMarker*> best;
    for (const PlacedMarker& first : all) {
        const bool known = std::find(best.begin(), best.end(), &first) != best.end();
        if (known) continue;
        auto joined = agreeing(all, first);
        if (joined.size() > best.size()) best = std::move(joined);
    }
    std::vector<const PlacedMarker*> by_number(static_cast<std::size_t>(count), nullptr);
    for (const PlacedMarker* one : best)
        by_number[static_cast<std::size_t>(one->seen->number)] = one;
    if (static_cast<std::size_t>(count) -
            static_cast<std::size_t>(std::count(by_number.begin(), by_number.end(), nullptr)) <
        kLeastMarkers)
        return {};

    // Squares, row by row, of the marker that is in each.
    const int across = board.columns + 1;
    std::vector<const PlacedMarker*> in_square(static_cast<std::size_t>(across * (board.rows + 1)));
    for (int row = 0, number = 0; row <= board.rows; ++row)
        for (int column = 0; column < across; ++column)
            if ((row + column) % 2 == 1)
                in_square[static_cast<std::size_t>(row * across + column)] =
                    by_number[static_cast<std::size_t>(number++)];
    const std::vector<glm::dvec2> board_mm = corners_mm(board);
    std::vector<std::optional<glm::dvec2>> corners(board_mm.size());
    for (std::size_t k = 0; k < corners.size(); ++k) {
        const int row = static_cast<int>(k) / board.columns;
        const int column = static_cast<int>(k) % board.columns;
        // Of the four squares around it, the two white ones lie across from each other.
        std::vector<const PlacedMarker*> beside;
        for (const int down : {0, 1})
            for (const int right : {0, 1}) {
                const PlacedMarker* one =
                    in_square[static_cast<std::size_t>((row + down) * across + column + right)];
                if (one != nullptr) beside.push_back(one);
            }
        if (beside.size() < 2) continue;
        // The gap between a marker and its square's border: no marker is in the window.
        const double side_px = std::min(beside[0]->side_px, beside[1]->side_px);
        const double gap_px = 0.5 * side_px * (board.square_mm / board.marker_mm - 1.0);
        const int reach = std::clamp(static_cast<int>(gap_px), 2, 15);
        const std::array<glm::dvec2, 1> guess{mapped(px_from_board(beside), board_mm[k])};
        if (!(guess[0].x > reach && guess[0].y > reach && guess[0].x < grey.width - reach &&
              guess[0].y < grey.height - reach))
            continue;
        corners[k] = refined_corners(grey, guess, reach).front();
    }
    return corners;
}

}  // namespace livery
