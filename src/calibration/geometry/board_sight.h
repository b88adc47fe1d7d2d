// The photographs of one pose of a board -> its corners in the camera's and the projector's
// picture, or what is wrong with them and what helps.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "calibration/correspondence/gray_code.h"
#include "calibration/geometry/board.h"
#include "calibration/geometry/solve_pair.h"
#include "core/progress.h"

namespace livery {

struct SightSearch {
    std::optional<BoardSight> sight;
    std::string reason;       ///< why there is none, and the way out
    std::size_t corners = 0;  ///< carried to the projector
    /// Of a chessboard, mean width of the edges between squares, 10% to 90%; of others 0.
    double edge_px = 0.0;
    /// How far the corners lie from those of the white picture in the pair of stripes where they do
    /// most: their median distance, camera pixels.
    double moved_px = 0.0;
};

/// `photographs`: of one channel and one size, among them `white` and pairs of stripes;
/// `projector_px`: what was decoded of them (CameraToProjector). The corners are looked for in
/// white and once more in the sum of each pair of stripes, which shows what white shows. Throws as
/// find_board(), FileError where there is no white picture, Cancelled between two of these steps.
SightSearch search_sight(const std::vector<RoledPhotograph>& photographs,
                         const ImageF& projector_px,
                         const Board& board,
                         const Progress& progress = {});

/// Why the board was not found in the white picture, or but `found` corners of a ChArUco board.
std::string why_not_found(const Image8& white, const Board& board, std::size_t found);

/// Where the board lies elsewhere than in the white picture.
struct BoardMovement {
    std::string role;  ///< of the pair of stripes where it lies farthest
    double px = 0.0;   ///< median distance of the corners
};

/// The corners are looked for within `reach_px` of `corners_px`, in the sum of each pair of
/// stripes; corners that are not there count as `reach_px` away. Throws Cancelled between pairs.
BoardMovement movement_during_code(const std::vector<RoledPhotograph>& photographs,
                                   const std::vector<glm::dvec2>& corners_px,
                                   int reach_px,
                                   const Progress& progress);

/// Width of the sharpest edges in a picture, about 10% to 90%, pixels: the span around the steepest
/// places over their gradient. 0 where the picture is even.
double sharpest_edge_px(const Image8& grey, int reach_px);

}  // namespace livery
