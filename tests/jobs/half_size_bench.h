// Shipped benches small enough for whole calibrations.
#pragma once

#include <string>

#include "twin/bench.h"

namespace livery {

/// A shipped bench with a quarter of its pixels.
inline BenchDescription half_size(const std::string& name) {
    BenchDescription description = read_bench_file(name);
    description.projector.view = resized(description.projector.view, 640, 400);
    description.camera.view = resized(description.camera.view, 864, 576);
    return description;
}

}  // namespace livery
