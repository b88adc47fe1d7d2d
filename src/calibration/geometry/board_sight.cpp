#include "calibration/geometry/board_sight.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "calibration/geometry/find_board.h"
#include "calibration/geometry/homography.h"
#include "core/error.h"
#include "core/statistics.h"
#include "core/worst_error.h"

namespace livery {

namespace {

/// Edges wider than this part of a square: the neighbouring corner's light reaches into the window
/// in which a corner is found, which is a third of a square.
constexpr double kWidestEdge = 1.0 / 3.0;
/// A board that moved by this in the camera is not the one that the stripes fell on.
constexpr double kMoved_px = 0.5;

/// Of a ChArUco board: a homography has eight unknowns, a corner two numbers, and a third are lost.
constexpr std::size_t kLeastCorners = 12;

/// The board's corners row by row, those that were found.
using Corners = std::vector<std::optional<glm::dvec2>>;

std::size_t count_of(const Corners& corners) {
    return static_cast<std::size_t>(std::count_if(
        corners.begin(), corners.end(), [](const auto& one) { return one.has_value(); }));
}

double spacing_of(const Corners& corners, int columns) {
    std::vector<double> apart;
    for (std::size_t i = 0; i + 1 < corners.size(); ++i)
        if ((i + 1) % static_cast<std::size_t>(columns) != 0 && corners[i] && corners[i + 1])
            apart.push_back(glm::distance(*corners[i], *corners[i + 1]));
    return median(apart);
}

Corners found_corners(const Image8& white, const Board& board) {
    if (board.kind == BoardKind::charuco) return find_charuco(white, board);
    const auto all = find_board(white, board.columns, board.rows);
    return {all.begin(), all.end()};
}

const ImageF& white_of(const std::vector<RoledPhotograph>& photographs) {
    for (const RoledPhotograph& one : photographs)
        if (one.role == "white") return one.photograph.image;
    throw FileError("captures", "role", "no photograph of white", "the Gray code's white picture");
}

double cross(glm::dvec2 a, glm::dvec2 b) { return a.x * b.y - a.y * b.x; }

/// Whether the board's squares run the other way round in the projector than in the camera.
bool turns_over(const Corners& seen, const Corners& lit, int columns) {
    int same = 0, other = 0;
    const auto row = static_cast<std::size_t>(columns);
    for (std::size_t k = 0; k + row < seen.size(); ++k) {
        if ((k + 1) % row == 0 || !lit[k] || !lit[k + 1] || !lit[k + row]) continue;
        const double in_camera = cross(*seen[k + 1] - *seen[k], *seen[k + row] - *seen[k]);
        const double in_projector = cross(*lit[k + 1] - *lit[k], *lit[k + row] - *lit[k]);
        (in_camera * in_projector > 0.0 ? same : other) += 1;
    }
    return other > same;
}

/// The corners that were found, carried to the projector.
Corners carried_to_projector(const ImageF& projector_px, const Corners& corners, double spacing) {
    std::vector<glm::dvec2> found;
    for (const auto& one : corners)
        if (one) found.push_back(*one);
    // Nearly half of a square: what belongs to the neighbouring corner stays out.
    const auto carried = carry_corners(projector_px, found, std::max(4.0, 0.45 * spacing));
    Corners all(corners.size());
    for (std::size_t k = 0, next = 0; k < corners.size(); ++k)
        if (corners[k]) all[k] = carried[next++];
    return all;
}

}  // namespace

SightSearch search_sight(const std::vector<RoledPhotograph>& photographs,
                         const ImageF& projector_px,
                         const Board& board,
                         const Progress& progress) {
    check_board(board);
    progress.check_stop();
    SightSearch result;
    const Image8 white = grey_for_corners(white_of(photographs));
    const Corners corners = found_corners(white, board);
    progress.check_stop();
    const std::size_t found = count_of(corners);
    if (found < kLeastCorners && found < static_cast<std::size_t>(board.columns * board.rows)) {
        result.reason = why_not_found(white, board, found);
        return result;
    }
    std::vector<glm::dvec2> seen;
    for (const auto& one : corners)
        if (one) seen.push_back(*one);
    const double spacing = spacing_of(corners, board.columns);
    if (board.kind == BoardKind::chessboard)
        result.edge_px = edge_width_px(white, board.columns, board.rows, seen);
    if (result.edge_px > kWidestEdge * spacing) {
        result.reason = fmt::format(
            "the board is blurred: its edges are {:.0f} px wide, its squares {:.0f} px; focus the "
            "camera on the board, and hold board and camera still",
            result.edge_px,
            spacing);
        return result;
    }
    const int reach = std::clamp(static_cast<int>(spacing / 3.0), 2, 15);
    const BoardMovement moved =
        movement_during_code(photographs, refined_corners(white, seen, reach), reach, progress);
    result.moved_px = moved.px;
    if (moved.px > kMoved_px) {
        result.reason = fmt::format(
            "the board lies {:.1f} px elsewhere in {} than in white{}: fix board, camera and "
            "projector, and photograph the pose again",
            moved.px,
            moved.role,
            moved.px > 0.9 * reach ? " or farther" : "");
        return result;
    }
    const Corners carried = carried_to_projector(projector_px, corners, spacing);
    result.corners = count_of(carried);
    if (2 * result.corners < found || result.corners < std::min(found, kLeastCorners)) {
        result.reason = fmt::format(
            "only {} of its {} corners lie where the Gray code could be decoded: the projector "
            "must light the whole board, and its dark squares must not be black",
            result.corners,
            found);
        return result;
    }
    if (turns_over(corners, carried, board.columns)) {
        result.reason =
            "camera and projector see the board mirrored to each other: switch off the projector's "
            "rear projection, or the mirroring of the camera's pictures";
        return result;
    }
    const std::vector<glm::dvec2> board_mm = corners_mm(board);
    result.sight.emplace();
    for (std::size_t k = 0; k < corners.size(); ++k) {
        if (!carried[k]) continue;
        result.sight->board_mm.push_back(board_mm[k]);
        result.sight->camera_px.push_back(*corners[k]);
        result.sight->projector_px.push_back(*carried[k]);
    }
    return result;
}

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
