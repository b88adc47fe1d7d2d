// What each paint swap costs. Items are the mock-up's pixels, fragments where a part is shaded.
#include <cstdint>
#include <vector>

#include "benchmarks/car.h"
#include "compensation/compensation.h"
#include "compensation/gpu_pass.h"
#include "gl/context.h"
#include "jobs/synthetic_calibration.h"

namespace livery::benchmarks {
namespace {

CompensationTable table_of(const FrameGeometry& geometry) {
    const ColourCalibration calibration = synthetic_calibration(geometry.map.coverage);
    return bake(calibration, design_white_luminance(calibration, 20.0, {}));
}

FramePlan draft_of(const Scene& scene) {
    return plan_frame(scene, Quality::draft, FrameStage::radiance);
}

/// A renderer whose light is solved and whose looks were all shown once.
struct Ready {
    HeadlessContext context{GlDevice::automatic};
    RadianceRenderer renderer;

    Ready(int width, ShadingDevice device) : renderer(geometry_of_width(width), false, device) {
        for (const Scene& look : car().looks) render(look);
    }
    void render(const Scene& look) {
        FramePlan plan = draft_of(look);
        renderer.render(look, plan);
    }
};

void repaint(benchmark::State& state, ShadingDevice device) {
    const Threads threads(state);
    Ready ready(static_cast<int>(state.range(0)), device);
    const int before = ready.renderer.counters().fragments_shaded;
    std::size_t k = 0;
    for (auto _ : state) {
        ready.render(car().looks[k++ % car().looks.size()]);
        benchmark::DoNotOptimize(ready.renderer.picture());
    }
    state.SetItemsProcessed(ready.renderer.counters().fragments_shaded - before);
}

void ShadingAndMixing(benchmark::State& state) { repaint(state, ShadingDevice::processor); }
BENCHMARK(ShadingAndMixing)->Apply(sizes_and_threads);

void ShadingAndMixingInOpenGl(benchmark::State& state) { repaint(state, ShadingDevice::gl); }
BENCHMARK(ShadingAndMixingInOpenGl)
    ->ArgNames({"width", "threads"})
    ->Args({640, 0})
    ->Args({1280, 0})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

void Correction(benchmark::State& state) {
    const Threads threads(state);
    const int width = static_cast<int>(state.range(0));
    Ready ready(width, ShadingDevice::automatic);
    const auto wanted = ready.renderer.picture();
    const CompensationTable table = table_of(*geometry_of_width(width));
    const std::size_t covered = count_covered(*wanted);
    Image8 drive;
    CompensationStats stats;
    for (auto _ : state) compensate_again(table, *wanted, covered, &drive, &stats);
    count_items(state, table.pixels.size());
}
BENCHMARK(Correction)->Apply(sizes_and_threads);

void CorrectionInOpenGl(benchmark::State& state) {
    const int width = static_cast<int>(state.range(0));
    Ready ready(width, ShadingDevice::automatic);
    const CompensationTable table = table_of(*geometry_of_width(width));
    GpuCompensation pass(table);
    for (auto _ : state) {
        pass.run(ready.renderer.texture());
        benchmark::DoNotOptimize(pass.read_back());
    }
    count_items(state, table.pixels.size());
}
BENCHMARK(CorrectionInOpenGl)
    ->ArgName("width")
    ->Arg(640)
    ->Arg(1280)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

void GamutMapping(benchmark::State& state) {
    const Threads threads(state);
    const int width = static_cast<int>(state.range(0));
    Ready ready(width, ShadingDevice::automatic);
    const CompensationTable table = table_of(*geometry_of_width(width));
    const GamutMap map(table);
    const auto wanted = ready.renderer.picture();
    for (auto _ : state) benchmark::DoNotOptimize(map.preserve(*wanted));
    count_items(state, table.pixels.size());
}
BENCHMARK(GamutMapping)->Apply(sizes_and_threads);

void BakingACalibration(benchmark::State& state) {
    const Threads threads(state);
    const FrameGeometry& geometry = *geometry_of_width(static_cast<int>(state.range(0)));
    const ColourCalibration calibration = synthetic_calibration(geometry.map.coverage);
    for (auto _ : state) benchmark::DoNotOptimize(bake(calibration, 0.3));
    count_items(state, geometry.map.covered_pixels);
}
BENCHMARK(BakingACalibration)->Apply(sizes_and_threads);

}  // namespace
}  // namespace livery::benchmarks
