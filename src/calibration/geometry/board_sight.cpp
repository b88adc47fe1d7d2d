#include "calibration/geometry/board_sight.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "calibration/geometry/board_faults.h"
#include "calibration/geometry/carry_corners.h"
#include "calibration/geometry/charuco.h"
#include "calibration/geometry/find_board.h"
#include "core/error.h"
#include "core/statistics.h"

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

}  // namespace livery
