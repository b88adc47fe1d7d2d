// How much distortion the photographs bear: the lens model that foretells a pose left out best.
#pragma once

#include <span>
#include <vector>

#include "calibration/geometry/solve_pair.h"

namespace livery {

struct ChosenModel {
    LensModel model = LensModel::k1;
    PairSolution solution;            ///< of all sights
    std::vector<double> held_out_px;  ///< a sight, fitted without it
    double held_out_rms_px = 0.0;     ///< over the sights
};

/// Leaves one sight out at a time, for each model; what a model cannot foretell counts against it.
/// Throws Refused as solve_pair(), for fewer than four sights and where no model foretells all.
ChosenModel choose_model(std::span<const BoardSight> sights,
                         PictureSize camera,
                         PictureSize projector,
                         const Progress& progress = {});

}  // namespace livery
