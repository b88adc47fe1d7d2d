#include "benchmarks/car.h"

#include <map>

#include "core/parallel.h"
#include "scene/library.h"
#include "twin/description.h"

namespace livery::benchmarks {

const Car& car() {
    static const Car made = [] {
        Car car;
        car.product = find_product("car");
        const BenchDescription bench = read_bench_file("default");
        car.projector = bench.projector.view;
        for (const std::string& name : shipped_looks()) {
            const auto loaded = car.looks.empty() ? nullptr : car.looks.back().environment;
            car.looks.push_back(make_scene(car.product, find_look(name), bench.eye_mm, loaded));
        }
        return car;
    }();
    return made;
}

const std::shared_ptr<const FrameGeometry>& geometry_of_width(int width) {
    static std::map<int, std::shared_ptr<const FrameGeometry>> made;
    auto& geometry = made[width];
    if (!geometry) {
        const View& view = car().projector;
        geometry = std::make_shared<const FrameGeometry>(
            car().product, resized(view, width, width * view.height / view.width));
    }
    return geometry;
}

void sizes_and_threads(benchmark::internal::Benchmark* benchmark) {
    benchmark->ArgNames({"width", "threads"})
        ->Unit(benchmark::kMillisecond)
        ->MeasureProcessCPUTime()
        ->UseRealTime();
    for (const int width : {640, 1280}) {
        for (const int threads : {1, 0}) benchmark->Args({width, threads});
    }
}

Threads::Threads(const benchmark::State& state) {
    set_thread_count(static_cast<int>(state.range(1)));
}

Threads::~Threads() { set_thread_count(0); }

void count_items(benchmark::State& state, std::size_t items) {
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(items));
}

}  // namespace livery::benchmarks
