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

}  // namespace livery
