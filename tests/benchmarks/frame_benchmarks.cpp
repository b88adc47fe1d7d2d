// What each paint swap costs. Items are the mock-up's pixels, fragments where a part is shaded.
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include <glm/geometric.hpp>

#include "appearance/subsurface/translucent_paint.h"
#include "benchmarks/car.h"
#include "compensation/compensation.h"
#include "compensation/gpu_pass.h"
#include "core/parallel.h"
#include "gl/context.h"
#include "gl/draw.h"
#include "jobs/synthetic_calibration.h"
#include "ledger/pass_costs.h"
#include "live/frame_lane.h"

namespace livery::benchmarks {
namespace {

CompensationTable table_of(const FrameGeometry& geometry,
                           GamutMapping gamut = GamutMapping::strict) {
    const ColourCalibration calibration = synthetic_calibration(geometry.map.coverage);
    return bake(calibration, design_white_luminance(calibration, 20.0, {}), gamut);
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

/// Every part in one model, each time in another colour.
void shade_model(
    benchmark::State& state, ReflectanceModel model, bool film, bool glints, ShadingDevice device) {
    set_thread_count(1);
    Ready ready(640, device);
    Scene look = car().looks.front();
    for (Material& material : look.part_materials) {
        material = Material();
        material.model = model;
        material.alpha = glm::dvec2(0.2);
        material.f0 = glm::dvec3(model == ReflectanceModel::lambert ? 0.04 : 0.4);
        material.coat_transmittance = {0.9, 0.8, 0.7};
        if (film) material.film_nm = 350.0;
        if (glints) material.glint_density_per_mm2 = 100.0;
    }
    double green = 0.0;
    for (auto _ : state) {
        green = green < 0.5 ? green + 0.01 : 0.1;
        for (Material& material : look.part_materials) material.diffuse = {0.2, green, 0.3};
        ready.render(look);
        if (device == ShadingDevice::gl) finish_gl();
    }
    set_thread_count(0);
}
constexpr auto kProcessor = ShadingDevice::processor, kGl = ShadingDevice::gl;
#define LIVERY_SHADE_MODEL(name, model, film, glints)                                       \
    BENCHMARK_CAPTURE(shade_model, name, ReflectanceModel::model, film, glints, kProcessor) \
        ->MeasureProcessCPUTime()                                                           \
        ->Unit(benchmark::kMillisecond);                                                    \
    BENCHMARK_CAPTURE(shade_model, name##_gl, ReflectanceModel::model, film, glints, kGl)   \
        ->MeasureProcessCPUTime()                                                           \
        ->Unit(benchmark::kMillisecond);
LIVERY_SHADE_MODEL(lambert, lambert, false, false)
LIVERY_SHADE_MODEL(ggx, ggx, false, false)
LIVERY_SHADE_MODEL(clearcoat, clearcoat, false, false)
LIVERY_SHADE_MODEL(car_paint, car_paint, false, false)
LIVERY_SHADE_MODEL(car_paint_film, car_paint, true, false)
LIVERY_SHADE_MODEL(car_paint_glints, car_paint, false, true)
#undef LIVERY_SHADE_MODEL

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
    CompensationCounts counts;
    Texture2D drive(table.width, table.height, TexelFormat::rgba8);
    for (auto _ : state) {
        pass.run(ready.renderer.texture(), drive, counts);
        benchmark::DoNotOptimize(counts.read(0));
    }
    count_items(state, table.pixels.size());
}
BENCHMARK(CorrectionInOpenGl)
    ->ArgName("width")
    ->Arg(640)
    ->Arg(1280)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

void CorrectionWithGamutMapping(benchmark::State& state) {
    const Threads threads(state);
    const int width = static_cast<int>(state.range(0));
    Ready ready(width, ShadingDevice::automatic);
    const CompensationTable table = table_of(*geometry_of_width(width), GamutMapping::preserve);
    ImageF wanted = *ready.renderer.picture();
    // Scaled so that fewer and more colours lie out of reach.
    for (std::size_t i = 0; i < wanted.values.size(); ++i) {
        if (i % 4 != 3) wanted.values[i] *= static_cast<float>(state.range(2)) / 100.0f;
    }
    const std::size_t covered = count_covered(wanted);
    Image8 drive;
    CompensationStats stats;
    for (auto _ : state) compensate_again(table, wanted, covered, &drive, &stats);
    state.counters["out_of_gamut"] = stats.out_of_gamut_fraction;
    count_items(state, table.pixels.size());
}
BENCHMARK(CorrectionWithGamutMapping)
    ->ArgNames({"width", "threads", "percent"})
    ->ArgsProduct({{1280}, {1, 0}, {20, 50, 100, 400}})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

/// A paint swap as a lane of the window does it, until the projector's texture is there.
void swap(benchmark::State& state, ShadingDevice device) {
    HeadlessContext context(GlDevice::automatic);
    const FrameGeometry& geometry = *geometry_of_width(static_cast<int>(state.range(0)));
    auto setup = std::make_shared<ProjectorSetup>();
    setup->view = geometry.view;
    setup->table =
        table_of(geometry, state.range(1) != 0 ? GamutMapping::preserve : GamutMapping::strict);
    FrameDescription description;
    description.scene = car().looks.front();
    description.quality = Quality::draft;
    description.setup = setup;
    FrameLane lane(std::make_shared<GeometryCache>(), device);
    lane.solve(description, levels_of(description.quality), {}, {});
    double compensate_ms = 0.0;
    std::size_t k = 0;
    const auto next = [&] {
        description.scene.part_materials = car().looks[k++ % car().looks.size()].part_materials;
        const auto frame = lane.draw(description);
        frame->ready->wait_for(60.0);
        return frame->compensate_ms;
    };
    for (std::size_t warm = 0; warm < 8; ++warm) next();
    for (auto _ : state) compensate_ms += next();
    state.counters["correction_ms"] =
        benchmark::Counter(compensate_ms, benchmark::Counter::kAvgIterations);
}

void SwapOnTheProcessor(benchmark::State& state) { swap(state, ShadingDevice::processor); }
BENCHMARK(SwapOnTheProcessor)
    ->ArgNames({"width", "mapping"})
    ->ArgsProduct({{640, 1280}, {0, 1}})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

void SwapInOpenGl(benchmark::State& state) { swap(state, ShadingDevice::gl); }
BENCHMARK(SwapInOpenGl)
    ->ArgNames({"width", "mapping"})
    ->ArgsProduct({{640, 1280}, {0, 1}})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

/// Each pass's milliseconds an iteration.
void count_passes(benchmark::State& state, const std::map<std::string, double>& ms) {
    for (const auto& [pass, sum] : ms) {
        if (sum <= 0.0) continue;
        state.counters[pass] = benchmark::Counter(sum, benchmark::Counter::kAvgIterations);
    }
}

/// A light, an eye or an environment that the mouse drags, as a draft shows it: what a lane solves
/// and draws for each of its steps, until the projector's texture is there. The mouse begins on a
/// picture that is finished.
template <typename Move>
void drag(benchmark::State& state, const Move& move) {
    HeadlessContext context(GlDevice::automatic);
    const FrameGeometry& geometry = *geometry_of_width(static_cast<int>(state.range(0)));
    auto setup = std::make_shared<ProjectorSetup>();
    setup->view = geometry.view;
    setup->table = table_of(geometry);
    FrameDescription description;
    description.scene = car().looks.front();
    description.quality = Quality::draft;
    description.setup = setup;
    FrameLane lane(std::make_shared<GeometryCache>());
    int step = 0;
    lane.solve(description, levels_of(Quality::normal), {}, {});
    const auto next = [&] {
        move(description.scene, 0.02 * ++step);
        lane.solve(description, levels_of(description.quality), {}, {});
        const auto frame = lane.draw(description);
        frame->ready->wait_for(60.0);
        return frame->plan;
    };
    for (int warm = 0; warm < 3; ++warm) next();
    std::map<std::string, double> ms;
    for (auto _ : state) {
        for (const PlannedPass& pass : next().passes) {
            ms[to_string(cost_key(pass.id))] += pass.ms.value_or(0.0);
        }
    }
    count_passes(state, ms);
}

void DraggingTheEye(benchmark::State& state) {
    const glm::dvec3 eye_mm = car().looks.front().eye_in_world_mm;
    drag(state, [&](Scene& scene, double step) {
        scene.eye_in_world_mm = eye_mm + glm::dvec3(1000.0 * step, 0.0, 0.0);
    });
}
BENCHMARK(DraggingTheEye)
    ->ArgName("width")
    ->Arg(640)
    ->Arg(1280)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

void DraggingALight(benchmark::State& state) {
    drag(state, [&](Scene& scene, double step) {
        glm::dvec3& to_light = scene.lights.front().direction;
        to_light = glm::normalize(to_light + glm::dvec3(0.05 * step, 0.0, 0.0));
    });
}
BENCHMARK(DraggingALight)
    ->ArgName("width")
    ->Arg(640)
    ->Arg(1280)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

void TurningTheEnvironment(benchmark::State& state) {
    drag(state, [&](Scene& scene, double step) {
        auto turned = std::make_shared<Environment>(*scene.environment);
        turned->rotation_rad = step;
        scene.environment = std::move(turned);
    });
}
BENCHMARK(TurningTheEnvironment)
    ->ArgName("width")
    ->Arg(640)
    ->Arg(1280)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

/// A colour or a depth of a translucent body that a designer drags, as it is solved behind the
/// draft that the mock-up shows meanwhile: marble as of a car of full size, in the studio's light.
void translucent_body(benchmark::State& state,
                      const std::function<void(TranslucentMaterial&, double)>& change) {
    HeadlessContext context(GlDevice::automatic);
    const Car& bench = car();
    Scene scene = bench.looks.front();
    const auto body = static_cast<std::size_t>(part_index(*bench.product, "body"));
    const TranslucentMaterial marble = read_translucent_material("marble");
    const TranslucentMaterial large =
        with_mean_free_path(marble, bench.product->product_scale * mean_free_path_mm(marble));
    RadianceRenderer renderer(
        geometry_of_width(static_cast<int>(state.range(0))), false, ShadingDevice::processor);
    int step = 0;
    const auto next = [&] {
        TranslucentMaterial medium = large;
        change(medium, 0.01 * (1 + step++ % 20));
        scene.part_materials[body] = translucent_paint(medium);
        FramePlan plan = plan_frame(scene, Quality::normal, FrameStage::radiance);
        renderer.render(scene, plan);
        return plan;
    };
    next();
    std::map<std::string, double> ms;
    for (auto _ : state) {
        for (const PlannedPass& pass : next().passes) {
            ms[to_string(cost_key(pass.id))] += pass.ms.value_or(0.0);
        }
    }
    count_passes(state, ms);
}

void AnotherColourOfATranslucentBody(benchmark::State& state) {
    translucent_body(state, [](TranslucentMaterial& medium, double part) {
        medium.sigma_a_per_mm *= 1.0 + part;
    });
}
BENCHMARK(AnotherColourOfATranslucentBody)
    ->ArgName("width")
    ->Arg(640)
    ->Arg(1280)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

void AnotherDepthOfATranslucentBody(benchmark::State& state) {
    translucent_body(state, [](TranslucentMaterial& medium, double part) {
        medium = with_mean_free_path(medium, (1.0 + part) * mean_free_path_mm(medium));
    });
}
BENCHMARK(AnotherDepthOfATranslucentBody)
    ->ArgName("width")
    ->Arg(640)
    ->Arg(1280)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

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
