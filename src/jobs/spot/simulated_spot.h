// Photographs of a spot of light on a translucent sample and on white, taken on the simulated
// stand: what `livery measure profile` reads, for anybody who wants to try it without a camera.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>

#include "core/progress.h"
#include "twin/spot_stand.h"

namespace livery {

struct SimulatedSpotRequest {
    SpotStand stand;
    std::filesystem::path out;
    std::uint64_t seed = 1;  ///< of the photographs' noise
};

struct SimulatedSpot {
    std::size_t photographs = 0;
};

/// Writes 000.png, ... with manifest.json and camera.json: sample and white, each with the spot and
/// without, in two exposures or more.
SimulatedSpot photograph_spot(const SimulatedSpotRequest& request, const Progress& progress = {});

}  // namespace livery
