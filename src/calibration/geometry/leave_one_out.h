// Lenses from boards, and how far off they are on a board that they were not fitted to.
#pragma once

#include <span>
#include <vector>

#include "calibration/geometry/solve_pair.h"

namespace livery {

struct CheckedPair {
    PairSolution solution;            ///< of all sights
    std::vector<double> held_out_px;  ///< a sight, by the solution of the others
    double held_out_rms_px = 0.0;     ///< over the sights
};

/// solve_pair(), then once more without each sight (leave-one-out). Throws Refused as solve_pair(),
/// for fewer than four sights, and where the others do not determine the lenses. Cancelled ends it
/// at the next iteration of the fit it is in.
CheckedPair solve_leaving_each_out(std::span<const BoardSight> sights,
                                   PictureSize camera,
                                   PictureSize projector,
                                   const Progress& progress = {});

}  // namespace livery
