// What the benchmarks share, made when the first of them asks for it.
#pragma once

#include <memory>
#include <vector>

#include <benchmark/benchmark.h>

#include "radiance/renderer.h"
#include "scene/scene.h"
#include "scene/view.h"

namespace livery::benchmarks {

/// The shipped car on the default bench, 1280x800, in the light of the shipped looks.
struct Car {
    std::shared_ptr<const Product> product;
    std::vector<Scene> looks;
    View projector;
};
const Car& car();

/// Its surface map in a picture of this width.
const std::shared_ptr<const FrameGeometry>& geometry_of_width(int width);

/// Widths of the projectors that a stage is timed for, and one and all threads: {width, threads}.
void sizes_and_threads(benchmark::internal::Benchmark* benchmark);
/// Uses the second argument's number of threads (0: all) until the object ends.
class Threads {
  public:
    explicit Threads(const benchmark::State& state);
    ~Threads();
    Threads(const Threads&) = delete;
    Threads& operator=(const Threads&) = delete;
};

/// Rate of `items` an iteration.
void count_items(benchmark::State& state, std::size_t items);

}  // namespace livery::benchmarks
