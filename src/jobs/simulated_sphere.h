// Photographs of a painted sphere, taken on the simulated stand: what `livery measure brdf` reads,
// for anybody who wants to try it without a camera.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>

#include "appearance/material.h"
#include "core/progress.h"
#include "twin/sphere_stand.h"

namespace livery {

struct SimulatedSphereRequest {
    SphereStand stand;
    Material paint;
    std::filesystem::path out;
    std::uint64_t seed = 1;
};

struct SimulatedSphere {
    std::size_t photographs = 0, lamps = 0;
};

/// Writes 000.png, ... with manifest.json: under each lamp from two exposures on, the shortest such
/// that nothing clips, the longest such that half of what is lit passes the middle of the scale;
/// then one of a white sphere in the same place.
SimulatedSphere photograph_sphere(const SimulatedSphereRequest& request,
                                  const Progress& progress = {});

}  // namespace livery
