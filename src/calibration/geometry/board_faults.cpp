#include "calibration/geometry/board_faults.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "calibration/geometry/charuco.h"
#include "calibration/geometry/find_board.h"
#include "core/statistics.h"
#include "core/worst_error.h"

namespace livery {

namespace {

const ImageF* image_of(const std::vector<RoledPhotograph>& photographs, const std::string& role) {
    for (const RoledPhotograph& one : photographs)
        if (one.role == role) return &one.photograph.image;
    return nullptr;
}

double gradient_at(const Image8& grey, int x, int y) {
    // Means of three rows and columns: noise alone is no edge.
    double across = 0.0, down = 0.0;
    for (int k = -1; k <= 1; ++k) {
        across += grey.at(x + 1, y + k) - grey.at(x - 1, y + k);
        down += grey.at(x + k, y + 1) - grey.at(x + k, y - 1);
    }
    return std::hypot(across, down) / 6.0;
}

double span_around(const Image8& grey, int x, int y, int reach) {
    int low = 255, high = 0;
    for (int v = std::max(0, y - reach); v < std::min(grey.height, y + reach + 1); ++v)
        for (int u = std::max(0, x - reach); u < std::min(grey.width, x + reach + 1); ++u) {
            low = std::min(low, static_cast<int>(grey.at(u, v)));
            high = std::max(high, static_cast<int>(grey.at(u, v)));
        }
    return high - low;
}

std::string blurred_picture(double sharpest_px) {
    return fmt::format(
        "the white picture is blurred: its sharpest edges are {:.0f} px wide; focus the camera on "
        "the board, and hold board and camera still",
        sharpest_px);
}

std::string why_another_grid(glm::ivec2 grid, const Board& board) {
    const auto [least, most] = std::minmax(grid.x, grid.y);
    const auto [asked_least, asked_most] = std::minmax(board.columns, board.rows);
    if (most > asked_most || least > asked_least)
        return fmt::format(
            "the board in the white picture has {}x{} inner corners, not {}x{}: photograph the "
            "same board in every pose, and give its corners, not its squares, as --board",
            most,
            least,
            board.columns,
            board.rows);
    return fmt::format(
        "only {}x{} of the board's {}x{} inner corners are seen in the white picture: the rest is "
        "hidden, cut off or in the dark, or it is another board; all of it must be seen and lit, "
        "with a white border",
        most,
        least,
        board.columns,
        board.rows);
}

std::string why_no_charuco(const Image8& white,
                           const Board& board,
                           std::size_t found,
                           bool blurred) {
    if (found > 0)
        return fmt::format(
            "only {} of the ChArUco board's {} corners lie between two markers that can be read: "
            "show more of it, nearer and sharper",
            found,
            board.columns * board.rows);
    const auto grid = find_any_grid(white);
    // Between markers there are no corners of four squares alone.
    if (grid && read_markers(white, find_quadrilaterals(white), kMarkers).empty()) {
        const auto [least, most] = std::minmax(grid->x, grid->y);
        return fmt::format(
            "a chessboard of {0}x{1} inner corners without markers in the white picture: give it "
            "as --board {0}x{1}, or photograph the ChArUco board",
            most,
            least);
    }
    if (blurred) return blurred_picture(sharpest_edge_px(white, white.width / 8));
    return fmt::format(
        "no ChArUco board of {}x{} inner corners in the white picture: its markers (ArUco "
        "original, {:g} mm) must be sharp and at least 20 px wide, and --board, --square-mm and "
        "--marker-mm those of the print",
        board.columns,
        board.rows,
        board.marker_mm);
}

}  // namespace

double sharpest_edge_px(const Image8& grey, int reach_px) {
    struct Place {
        double gradient;
        int x, y;
    };
    std::vector<Place> places;
    for (int y = 1; y + 1 < grey.height; ++y)
        for (int x = 1; x + 1 < grey.width; ++x) places.push_back({gradient_at(grey, x, y), x, y});
    // Enough to outvote a few hot pixels, few enough to be edges.
    const std::size_t kept = std::min<std::size_t>(places.size(), 100 + places.size() / 1000);
    std::partial_sort(places.begin(),
                      places.begin() + static_cast<std::ptrdiff_t>(kept),
                      places.end(),
                      [](const Place& a, const Place& b) { return a.gradient > b.gradient; });
    std::vector<double> widths;
    for (std::size_t k = 0; k < kept; k += std::max<std::size_t>(1, kept / 100)) {
        const Place& one = places[k];
        if (one.gradient > 0.0)
            widths.push_back(span_around(grey, one.x, one.y, reach_px) / one.gradient);
    }
    return median(widths);
}

std::string why_not_found(const Image8& white, const Board& board, std::size_t found) {
    // A board of so many squares that fills the picture has squares of this size; edges wider than
    // a third of them leave no corner by itself.
    const int limit = std::max(4, white.width / (3 * (board.columns + 3)));
    const double sharpest = sharpest_edge_px(white, 2 * limit);
    if (board.kind == BoardKind::charuco)
        return why_no_charuco(white, board, found, sharpest > limit);
    const auto grid = find_any_grid(white);
    if (grid) return why_another_grid(*grid, board);
    if (sharpest > limit) return blurred_picture(sharpest);
    return fmt::format(
        "no board of {}x{} inner corners in the white picture: all of it must be seen, flat, sharp "
        "and lit, with a white border",
        board.columns,
        board.rows);
}

BoardMovement movement_during_code(const std::vector<RoledPhotograph>& photographs,
                                   const std::vector<glm::dvec2>& corners_px,
                                   int reach_px,
                                   const Progress& progress) {
    // The search gives a corner back as it came where it finds none: begun beside the place, that
    // is told from a corner that stayed.
    constexpr glm::dvec2 kBeside(0.375, 0.25);
    std::vector<glm::dvec2> starts;
    for (const glm::dvec2& corner : corners_px) starts.push_back(corner + kBeside);
    BoardMovement worst;
    for (const RoledPhotograph& one : photographs) {
        const ImageF* inverse = image_of(photographs, one.role + "-inverse");
        if (inverse == nullptr) continue;
        progress.check_stop();
        ImageF sum = one.photograph.image;
        for (std::size_t i = 0; i < sum.values.size(); ++i) sum.values[i] += inverse->values[i];
        const auto there = refined_corners(grey_for_corners(sum), starts, reach_px);
        std::vector<double> apart;
        for (std::size_t k = 0; k < there.size(); ++k) {
            const bool lost = glm::distance(there[k], starts[k]) < 1e-3;
            apart.push_back(lost ? reach_px : glm::distance(there[k], corners_px[k]));
        }
        const double off = worst_if_nan(median(apart));
        if (off > worst.px) worst = {one.role, off};
    }
    return worst;
}

}  // namespace livery
