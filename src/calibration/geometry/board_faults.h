// What keeps a board from being found or used, in words with the way out.
#pragma once

#include <string>
#include <vector>

#include "calibration/correspondence/gray_code.h"
#include "calibration/geometry/board_sight.h"

namespace livery {

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
