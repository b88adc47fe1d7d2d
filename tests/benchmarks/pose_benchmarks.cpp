// What a pose and its light cost once.
#include "benchmarks/car.h"
#include "radiance/light/environment_filter.h"
#include "radiance/light/light_visibility.h"
#include "radiance/light/mirror_visibility.h"
#include "radiance/light/sky_visibility.h"
#include "reference/path_tracer.h"

namespace livery::benchmarks {
namespace {

void EmbreeBuild(benchmark::State& state) {
    const Mesh& mesh = car().product->mesh;
    for (auto _ : state) benchmark::DoNotOptimize(Tracer(mesh));
}
BENCHMARK(EmbreeBuild)->Unit(benchmark::kMillisecond)->UseRealTime();

void SurfaceMapOfThePose(benchmark::State& state) {
    const Threads threads(state);
    const FrameGeometry& geometry = *geometry_of_width(static_cast<int>(state.range(0)));
    for (auto _ : state) {
        benchmark::DoNotOptimize(
            build_surface_map(car().product->mesh, *geometry.tracer, geometry.view, 16));
    }
    count_items(state, geometry.map.covered_pixels * 16);
}
BENCHMARK(SurfaceMapOfThePose)->Apply(sizes_and_threads);

void LightVisibility(benchmark::State& state) {
    const Threads threads(state);
    const FrameGeometry& geometry = *geometry_of_width(static_cast<int>(state.range(0)));
    const DirectionalLight& light = car().looks.front().lights.front();
    const SmoothRuns runs(geometry.map);
    for (auto _ : state) {
        benchmark::DoNotOptimize(light_at_fragments(
            car().product->mesh, *geometry.tracer, geometry.map, runs, light, 16));
    }
    count_items(state, geometry.map.fragments.size() * 16);
}
BENCHMARK(LightVisibility)->Apply(sizes_and_threads);

void SkyVisibilityOfThePose(benchmark::State& state) {
    const Threads threads(state);
    const FrameGeometry& geometry = *geometry_of_width(static_cast<int>(state.range(0)));
    const SmoothRuns runs(geometry.map);
    for (auto _ : state) {
        benchmark::DoNotOptimize(solve_sky_visibility(
            car().product->mesh, *geometry.tracer, geometry.map, runs, SkyRays{16, 128, false}));
    }
    count_items(state, geometry.map.fragments.size() * 16);
}
BENCHMARK(SkyVisibilityOfThePose)->Apply(sizes_and_threads);

void MirrorVisibilityOfThePose(benchmark::State& state) {
    const Threads threads(state);
    const FrameGeometry& geometry = *geometry_of_width(static_cast<int>(state.range(0)));
    const SmoothRuns runs(geometry.map);
    for (auto _ : state) {
        const Mesh& mesh = car().product->mesh;
        MirrorVisibility visibility(geometry.map, mesh.parts.size(), 16);
        add_mirror_visibility(mesh,
                              *geometry.tracer,
                              geometry.map,
                              runs,
                              car().looks.front().eye_in_world_mm,
                              std::vector<bool>(mesh.parts.size(), true),
                              {},
                              visibility);
        benchmark::DoNotOptimize(visibility);
    }
    count_items(state, geometry.map.fragments.size());
}
BENCHMARK(MirrorVisibilityOfThePose)->Apply(sizes_and_threads);

void EnvironmentFilter(benchmark::State& state) {
    const Environment& environment = *car().looks.front().environment;
    for (auto _ : state) {
        benchmark::DoNotOptimize(
            filter_environment(environment, FilterParts{false, true, true, true}));
    }
    count_items(state, kFilterTexels);
}
BENCHMARK(EnvironmentFilter)->Unit(benchmark::kMillisecond)->UseRealTime();

void PathTracer(benchmark::State& state) {
    const View view = cropped(car().projector, 680, 470, 80, 50);
    ReferenceOptions options;
    options.bounces = 0;  // as what is drawn
    options.samples_per_pixel = 4;
    for (auto _ : state) {
        benchmark::DoNotOptimize(trace_reference(car().looks.front(), view, options));
    }
    count_items(state, 80 * 50 * 4);
}
BENCHMARK(PathTracer)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();

}  // namespace
}  // namespace livery::benchmarks
