// Photographs of a patterns folder, taken on the simulated bench: a captures folder for anybody who
// wants to try the calibration without a camera.
#pragma once

#include <cstddef>
#include <filesystem>

#include "core/progress.h"
#include "twin/description.h"

namespace livery {

struct SimulatedCapturesRequest {
    BenchDescription bench;
    std::filesystem::path patterns;  ///< folder written by `livery patterns`
    std::filesystem::path out;
    double exposure_s = 0.0;  ///< 0: as the bench meters
};

struct SimulatedCaptures {
    std::size_t photographs = 0;
    double exposure_s = 0.0;
};

/// Writes 000.exr, ... with manifest.json, the colorimeter's readings as camera-to-xyz.json
/// and the projector's view as projector.json.
SimulatedCaptures photograph_patterns(const SimulatedCapturesRequest& request,
                                      const Progress& progress = {});

}  // namespace livery
