// Photographs of a mirror ball, taken on the simulated stand: what `livery measure environment`
// reads, for anybody who wants to try it without a camera.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <vector>

#include "core/progress.h"
#include "twin/mirror_ball_stand.h"

namespace livery {

struct SimulatedBallRequest {
    MirrorBallStand stand;
    LightFrom light_from;
    std::filesystem::path out;
    std::uint64_t seed = 1;
    int samples_a_side = 6;           ///< rays a pixel, squared
    std::vector<double> exposures_s;  ///< of every camera; empty: as its light asks for
};

struct SimulatedBall {
    std::size_t photographs = 0, cameras = 0;
};

/// Writes 000.png, ... with manifest.json and a camera file for each camera.
SimulatedBall photograph_ball(const SimulatedBallRequest& request, const Progress& progress = {});

}  // namespace livery
