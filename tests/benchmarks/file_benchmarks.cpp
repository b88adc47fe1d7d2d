// What is read before anything is drawn.
#include "appearance/material_library.h"
#include "benchmarks/car.h"
#include "core/json.h"
#include "core/paths.h"
#include "scene/library.h"

namespace livery::benchmarks {
namespace {

void LoadTheCar(benchmark::State& state) {
    for (auto _ : state) benchmark::DoNotOptimize(find_product("car"));
    count_items(state, car().product->mesh.triangles.size());
}
BENCHMARK(LoadTheCar)->Unit(benchmark::kMillisecond)->UseRealTime();

void LoadThePaints(benchmark::State& state) {
    std::size_t paints = 0;
    for (auto _ : state) paints = read_paint_library()->shipped.size();
    count_items(state, paints);
}
BENCHMARK(LoadThePaints)->Unit(benchmark::kMillisecond);

void LoadALook(benchmark::State& state) {
    for (auto _ : state) benchmark::DoNotOptimize(find_look("blue-metallic"));
}
BENCHMARK(LoadALook)->Unit(benchmark::kMicrosecond);

void LoadAnEnvironment(benchmark::State& state) {
    const Look look = find_look("blue-metallic");
    for (auto _ : state) {
        benchmark::DoNotOptimize(
            make_scene(car().product, look, car().looks.front().eye_in_world_mm));
    }
}
BENCHMARK(LoadAnEnvironment)->Unit(benchmark::kMillisecond);

void ParseJson(benchmark::State& state) {
    const std::filesystem::path file = shipped_look_file("blue-metallic");
    const std::string text = read_text_file(file);
    for (auto _ : state) benchmark::DoNotOptimize(parse_json(text, file));
    state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(text.size()));
}
BENCHMARK(ParseJson)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace livery::benchmarks
