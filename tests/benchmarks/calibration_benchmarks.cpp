// What a calibration computes, less the taking of photographs.
#include "benchmarks/car.h"
#include "calibration/colour/colour.h"
#include "calibration/colour/colour_samples.h"
#include "calibration/colour/mixing.h"
#include "calibration/correspondence/fringe_decode.h"
#include "calibration/correspondence/gray_code.h"
#include "calibration/correspondence/patterns.h"
#include "jobs/calibrate/bench_calibration.h"
#include "jobs/comparison.h"
#include "twin/bench.h"

namespace livery::benchmarks {
namespace {

/// Gray code photographs of a camera that sees the projector's own pixels.
void GrayCodeDecoding(benchmark::State& state) {
    const int width = static_cast<int>(state.range(0)), height = width * 5 / 8;
    std::vector<Image8> photographs;
    for (const Pattern& pattern : geometry_patterns(width, height)) {
        Image8& seen = photographs.emplace_back(width, height, 1);
        for (std::size_t i = 0; i < seen.values.size(); ++i) {
            seen.values[i] = pattern.drive.values[3 * i] == 0 ? 8 : 200;
        }
    }
    for (auto _ : state) {
        benchmark::DoNotOptimize(
            decode_gray_code(std::span<const Image8>(photographs), width, height));
    }
    count_items(state, photographs.front().values.size());
}
BENCHMARK(GrayCodeDecoding)
    ->ArgName("width")
    ->Arg(640)
    ->Arg(1280)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

/// Ten fringes over the Gray code, of a camera that sees the projector's own pixels.
void FringeDecoding(benchmark::State& state) {
    const int width = static_cast<int>(state.range(0)), height = width * 5 / 8;
    std::vector<RoledPhotograph> photographs;
    for (const Pattern& pattern : place_patterns(PlaceCode::gray_and_phase, width, height)) {
        Photograph& seen = photographs.emplace_back(RoledPhotograph{pattern.role, {}}).photograph;
        seen.image = ImageF(width, height, 1);
        for (std::size_t i = 0; i < seen.image.values.size(); ++i) {
            const float drive = static_cast<float>(pattern.drive.values[3 * i]) / 255.0f;
            seen.image.values[i] = 8.0f + 192.0f * drive * drive;
        }
    }
    const CameraToProjector gray = decode_gray_code(photographs, width, height);
    for (auto _ : state) {
        benchmark::DoNotOptimize(refine_by_fringes(photographs, gray, width, height));
    }
    count_items(state, photographs.front().photograph.image.values.size());
}
BENCHMARK(FringeDecoding)
    ->ArgName("width")
    ->Arg(1280)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

/// The default bench with a quarter of the pixels a side, calibrated once.
struct Calibrated {
    CalibrationResult result;
    ColourSamples samples;

    Calibrated() {
        BenchDescription description = read_bench_file("default");
        for (View* view : {&description.projector.view, &description.camera.view}) {
            *view = resized(*view, view->width / 4, view->height / 4);
        }
        Bench bench(description, car().product);
        result =
            calibrate_through_ports(bench.ports(), settings_of(bench.description(), car().product));
        samples = sample_colours(result.captures, result.map);
    }
};
const Calibrated& calibrated() {
    static const Calibrated made;
    return made;
}

void ColourCalibrationOfASession(benchmark::State& state) {
    const CalibrationResult& live = calibrated().result;
    for (auto _ : state) {
        benchmark::DoNotOptimize(calibrate_colour(live.captures, live.patterns, live.map, {}));
    }
    count_items(state, calibrated().samples.pixels.size());
}
BENCHMARK(ColourCalibrationOfASession)->Unit(benchmark::kMillisecond)->UseRealTime();

void ColourMixingByPixel(benchmark::State& state) {
    const ColourSamples& samples = calibrated().samples;
    for (auto _ : state) benchmark::DoNotOptimize(mix_by_pixel(samples));
    count_items(state, samples.pixels.size());
}
BENCHMARK(ColourMixingByPixel)->Unit(benchmark::kMillisecond)->UseRealTime();

void ColourMixingPooled(benchmark::State& state) {
    const ColourSamples& samples = calibrated().samples;
    const PooledMixing pooled = pool_mixing(samples);
    for (auto _ : state) benchmark::DoNotOptimize(mix_robustly(samples, pooled, true));
    count_items(state, samples.pixels.size());
}
BENCHMARK(ColourMixingPooled)->Unit(benchmark::kMillisecond)->UseRealTime();

void Ciede2000OfAPicture(benchmark::State& state) {
    constexpr int kWidth = 640, kHeight = 400;
    ImageF wanted(kWidth, kHeight, 3), shown(kWidth, kHeight, 3);
    for (std::size_t i = 0; i < wanted.values.size(); ++i) {
        wanted.values[i] = 0.05f + 0.9f * static_cast<float>(i % 997) / 997.0f;
        shown.values[i] = 1.02f * wanted.values[i];
    }
    const Image8 every(kWidth, kHeight, 1, 255), none(kWidth, kHeight, 1, 0);
    const ComparisonMasks masks{every, none, every, every};
    for (auto _ : state) {
        benchmark::DoNotOptimize(compare_xyz(wanted, shown, glm::dvec3(0.95, 1.0, 1.09), masks));
    }
    count_items(state, wanted.pixel_count());
}
BENCHMARK(Ciede2000OfAPicture)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
}  // namespace livery::benchmarks
