#include "ledger/speed.h"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <map>
#include <stdexcept>

#include <fmt/format.h>

#include "appearance/model_table.h"
#include "compensation/compensation.h"
#include "compensation/gpu_pass.h"
#include "core/parallel.h"
#include "core/time.h"
#include "jobs/synthetic_calibration.h"
#include "ledger/accuracy/truth.h"
#include "ledger/desktop_times.h"
#include "ledger/first_frame_times.h"
#include "ledger/machine_speed.h"
#include "ledger/paint_times.h"
#include "radiance/renderer.h"
#include "scene/library.h"
#include "twin/description.h"

namespace livery {

namespace {

using Clock = std::chrono::steady_clock;

LedgerLevel worked_level_of(const std::string& name, std::vector<double> ms, double work_items) {
    LedgerLevel level = level_of(name, std::move(ms));
    level.work_items = work_items;
    return level;
}

template <typename Work>
std::vector<double> repeat(int count, const Progress& progress, const Work& work) {
    std::vector<double> ms;
    for (int k = 0; k < count; ++k) {
        progress.check_stop();
        const auto start = Clock::now();
        work(k);
        ms.push_back(milliseconds_since(start));
    }
    return ms;
}

/// The effect of that name, added when it is new.
LedgerEffect& effect(SpeedLedger& result, const std::string& name) {
    const auto known = std::find_if(result.effects.begin(),
                                    result.effects.end(),
                                    [&](const LedgerEffect& entry) { return entry.name == name; });
    if (known != result.effects.end()) return *known;
    return result.effects.emplace_back(LedgerEffect{name, {}});
}

/// What is timed: the levels of a quality, or the dearest ones, which no quality has.
struct TimedLevels {
    std::string name;
    EffectLevels levels;
};

std::vector<TimedLevels> timed_levels(bool quick) {
    std::vector<TimedLevels> list;
    // The first that has a level is what predictions of it come from
    for (const Quality quality : {Quality::normal, Quality::draft, Quality::high}) {
        list.push_back({to_string(quality), levels_of(quality)});
    }
    list.push_back({"dearest", dearest_levels()});
    // What no quality has: mirrors by few nodes, through parts
    EffectLevels few_nodes = levels_of(Quality::draft);
    few_nodes[Effect::mirrored_environment] = kMirrorsWithRays - 1;
    list.push_back({"draft with nodes", few_nodes});
    if (quick) list.resize(1);
    return list;
}

/// Milliseconds and work of every pass over the repeats at some levels.
struct PassTimes {
    std::map<PassId, std::vector<double>> ms;
    std::map<PassId, double> work_items;
};

/// What is solved once for a light is what it took the first time: later it stands, or only what a
/// paint changes of it is solved again.
void collect(PassTimes& times, const FramePlan& plan) {
    std::map<PassId, double> ms, items;
    for (const PlannedPass& pass : plan.passes) {
        if (!pass.ms || (!runs_every_frame(pass.id) && times.ms.contains(cost_key(pass.id)))) {
            continue;
        }
        ms[cost_key(pass.id)] += *pass.ms;
        items[cost_key(pass.id)] += pass.work_items;
    }
    for (const auto& [key, value] : ms) {
        if (value <= 0.0) continue;
        times.ms[key].push_back(value);
        times.work_items[key] = items[key];
    }
}

/// Of a pass at a level, in a smaller picture: with the larger one's it tells what even an empty
/// one takes.
using SmallTimes = std::map<std::pair<PassId, int>, LedgerLevel>;

PassCost cost_of(const PassId& key, int level, const LedgerLevel& large, const SmallTimes& smalls) {
    PassCost cost{key, level, large.ms, 0.0, large.work_items, std::nullopt};
    const auto small = smalls.find({key, level});
    if (small == smalls.end() || !(small->second.work_items < large.work_items)) return cost;
    const double slope =
        (large.ms - small->second.ms) / (large.work_items - small->second.work_items);
    cost.fixed_ms = std::clamp(small->second.ms - slope * small->second.work_items,
                               0.0,
                               std::min(large.ms, small->second.ms));
    return cost;
}

/// A paint of every model on the body, with glints where the model has them: shipped looks wear
/// few of them, and what has no time has no price.
void collect_paints(PassTimes& times,
                    RadianceRenderer& renderer,
                    const Scene& look,
                    const EffectLevels& levels,
                    const Progress& progress) {
    constexpr int kRepeats = 11;
    Scene scene = look;
    const auto body = static_cast<std::size_t>(part_index(*scene.product, "body"));
    std::vector<Material> paints;
    for (const ModelInfo& model : formula_models()) {
        Material& paint = paints.emplace_back();
        paint.model = model.model;
        if (model.model != ReflectanceModel::car_paint) continue;
        paints.push_back(paint);
        paints.back().glint_density_per_mm2 = 1000.0;
    }
    for (Material& paint : paints) {
        for (int k = 0; k < kRepeats; ++k) {
            progress.check_stop();
            paint.diffuse = glm::dvec3(k % 2 == 0 ? 0.05 : 0.06);
            scene.part_materials.at(body) = paint;
            FramePlan plan = plan_frame(scene, levels, FrameStage::radiance);
            renderer.render(scene, plan, progress);
            // The first compiles and touches what is kept; what it solved for all others counts
            if (k == 0) {
                std::erase_if(plan.passes,
                              [](const PlannedPass& pass) { return runs_every_frame(pass.id); });
            }
            collect(times, plan);
        }
    }
}

/// No look that is shipped is translucent, and what has no time has no price: the pass as it is for
/// another colour.
void add_costs(SpeedLedger& result, const TranslucentTimes& times) {
    for (std::size_t level = 0; level < times.pass_ms.size(); ++level) {
        if (times.pass_ms[level].empty()) continue;
        const LedgerLevel timed =
            worked_level_of(effect_info(Effect::subsurface).levels[level].name,
                            times.pass_ms[level],
                            times.body_fragments);
        effect(result, "pass " + to_string(PassId(PassKind::subsurface))).levels.push_back(timed);
        result.pass_costs.push_back({PassKind::subsurface,
                                     static_cast<int>(level),
                                     timed.ms,
                                     0.0,
                                     times.body_fragments,
                                     std::nullopt});
    }
}

struct TimedScene {
    std::shared_ptr<const Product> product;
    std::vector<Scene> looks;  ///< swapped in turn
    View projector;
};

TimedScene load_scene(SpeedLedger& result, const Progress& progress) {
    TimedScene scene;
    const auto loads = repeat(3, progress, [&](int) { scene.product = find_product("car"); });
    effect(result, "load the car").levels.push_back(worked_level_of("car.glb", loads, 0.0));
    const BenchDescription bench = read_bench_file("default");
    scene.projector = bench.projector.view;
    for (const std::string& name : shipped_looks()) {
        const auto loaded = scene.looks.empty() ? nullptr : scene.looks.back().environment;
        scene.looks.push_back(make_scene(scene.product, find_look(name), bench.eye_mm, loaded));
    }
    return scene;
}

/// One resolution and set of levels: the first frame, then paint swaps, with the compensation after
/// each.
void time_frames(SpeedLedger& result,
                 SmallTimes& smalls,
                 const TimedScene& scene,
                 const View& view,
                 const TimedLevels& timed,
                 const Progress& progress) {
    const EffectLevels& levels = timed.levels;
    const bool normal = levels == levels_of(Quality::normal);
    const std::string name = fmt::format("{}x{}, {}", view.width, view.height, timed.name);
    const auto start = Clock::now();
    RadianceRenderer renderer(std::make_shared<const FrameGeometry>(
        scene.product, view, progress, sub_samples_of(levels)));
    PassTimes passes;
    FramePlan first = plan_frame(scene.looks.front(), levels, FrameStage::radiance);
    renderer.render(scene.looks.front(), first, progress);
    const auto fragments = static_cast<double>(renderer.surface_map().fragments.size());
    effect(result, "first frame")
        .levels.push_back(worked_level_of(name, {milliseconds_since(start)}, fragments));
    collect(passes, first);
    const auto& map = renderer.surface_map();
    if (view.width == 1280) {
        result.covered_fraction = static_cast<double>(map.covered_pixels) /
                                  static_cast<double>(map.coverage.pixel_count());
    }

    const ColourCalibration calibration = synthetic_calibration(map.coverage);
    const CompensationTable table =
        bake(calibration, design_white_luminance(calibration, kDesignWhitePercentile, {}));
    GpuCompensation gpu(table);
    CompensationCounts counts;
    Texture2D input(view.width, view.height, TexelFormat::rgba8);
    // Programs and textures of every look are made before anything is timed.
    for (const Scene& look : scene.looks) {
        FramePlan plan = plan_frame(look, levels, FrameStage::projector);
        renderer.render(look, plan, progress);
        gpu.run(renderer.texture(), input, counts);
        counts.read(0);
    }
    const std::size_t covered = count_covered(*renderer.picture());

    constexpr int kSwaps = 31;
    std::vector<double> shade, gpu_ms, cpu_ms, gpu_frame, cpu_frame;
    Image8 drive;
    for (int k = 0; k < kSwaps; ++k) {
        progress.update(static_cast<double>(k) / kSwaps, "timing " + name);
        const Scene& look = scene.looks[static_cast<std::size_t>(k) % scene.looks.size()];
        FramePlan plan = plan_frame(look, levels, FrameStage::radiance);

        // As the window's front lane draws it: light between parts follows behind
        const auto began = Clock::now();
        renderer.render(look, plan, progress, LightBetweenParts::kept);
        const double rendered_ms = milliseconds_since(began);
        const auto wanted = renderer.picture();
        shade.push_back(milliseconds_since(began));
        collect(passes, plan);
        const auto before_cpu = Clock::now();
        CompensationStats stats;
        compensate_again(table, *wanted, covered, &drive, &stats);
        cpu_ms.push_back(milliseconds_since(before_cpu));
        cpu_frame.push_back(milliseconds_since(began));

        // The same with the correction in OpenGL, which fetches no picture; reading what it counted
        // waits until it is done.
        const auto before_gpu = Clock::now();
        gpu.run(renderer.texture(), input, counts);
        counts.read(covered);
        gpu_ms.push_back(milliseconds_since(before_gpu));
        gpu_frame.push_back(rendered_ms + gpu_ms.back());
    }
    const auto pixels = static_cast<double>(table.pixels.size());
    effect(result, "paint swap: shading and mixing")
        .levels.push_back(worked_level_of(name, shade, fragments));
    effect(result, "paint swap to projector input")
        .levels.push_back(worked_level_of(name, cpu_frame, fragments));
    effect(result, "paint swap to projector input, correction in OpenGL")
        .levels.push_back(worked_level_of(name, gpu_frame, fragments));
    if (normal) {
        const std::string size = fmt::format("{}x{}", view.width, view.height);
        effect(result, "correction").levels.push_back(worked_level_of(size, cpu_ms, pixels));
        effect(result, "correction in OpenGL, with its counts")
            .levels.push_back(worked_level_of(size, gpu_ms, pixels));
    }
    // The desktop corrects where it shades.
    passes.ms[PassKind::compensation] = renderer.device() == ShadingDevice::gl ? gpu_ms : cpu_ms;
    passes.work_items[PassKind::compensation] = pixels;
    if (view.width != 1280) {
        for (const auto& [key, ms] : passes.ms) {
            smalls.insert({{key, cost_level(key, levels)},
                           worked_level_of(name, ms, passes.work_items[key])});
        }
        return;
    }
    if (normal) {
        collect_paints(passes, renderer, scene.looks.front(), levels, progress);
        ArtworkTimes artwork = measure_artwork(renderer, scene.looks.front(), levels, progress);
        for (LedgerLevel& level : artwork.frames) {
            effect(result, "artwork over the body, shading beside a frame without")
                .levels.push_back(std::move(level));
        }
        // A prediction scales both by the fragments of the parts that wear it.
        TranslucentTimes translucent =
            measure_translucent(renderer, scene.looks.front(), levels, progress);
        for (LedgerLevel& level : translucent.first_frames) {
            effect(result, "translucent body: first frame").levels.push_back(std::move(level));
        }
        for (LedgerLevel& level : translucent.swaps) {
            effect(result, "translucent body: another colour").levels.push_back(std::move(level));
        }
        add_costs(result, translucent);
        passes.ms[PassKind::artwork] = artwork.cover_ms;
        passes.ms[PassKind::relief] = artwork.relief_ms;
        passes.work_items[PassKind::artwork] = passes.work_items[PassKind::relief] =
            artwork.body_fragments;
    }
    for (const auto& [key, ms] : passes.ms) {
        const LedgerLevel level = worked_level_of(name, ms, passes.work_items[key]);
        effect(result, "pass " + to_string(key)).levels.push_back(level);
        if (find_cost(result.pass_costs, key, levels)) continue;
        PassCost& cost =
            result.pass_costs.emplace_back(cost_of(key, cost_level(key, levels), level, smalls));
        if (key == PassKind::surface_map) {
            cost.fragments_per_pixel = fragments / static_cast<double>(map.covered_pixels);
        }
    }
}

/// What each quality level is worth: the first look against the path tracer with all bounces, over
/// the whole mock-up, a quarter of its pixels.
void compare_with_reference(SpeedLedger& result,
                            const TimedScene& scene,
                            const Progress& progress) {
    AccuracyScene whole;
    whole.scene = scene.looks.front();
    whole.view = resized(scene.projector, 320, 200);
    TruthOptions options;
    options.samples_per_pixel = 128;
    progress.update(0.0, "tracing the truth");
    const Truth truth = truth_of(whole, options, progress);
    for (const Quality quality : {Quality::draft, Quality::normal, Quality::high}) {
        RadianceRenderer renderer(std::make_shared<const FrameGeometry>(
            scene.product, whole.view, progress, sub_samples_of(quality)));
        FramePlan plan = plan_frame(whole.scene, quality, FrameStage::radiance);
        renderer.render(whole.scene, plan, progress);
        const ErrorStatistics error =
            statistics_of(colour_differences(renderer.read_back(), truth.radiance_working));

        const auto& frames = effect(result, "first frame").levels;
        const std::string name = fmt::format("1280x800, {}", to_string(quality));
        const auto frame =
            std::find_if(frames.begin(), frames.end(), [&](const LedgerLevel& level) {
                return level.name == name;
            });
        LedgerLevel level = *frame;
        level.error = error.median;
        level.error_p95 = error.p95;
        level.unit = "CIEDE2000";
        effect(result, "quality level: first frame, and its error").levels.push_back(level);
    }
}

SpeedLedger described(const HeadlessContext& context) {
    SpeedLedger result;
    // Zero where the system does not say.
    ::getloadavg(&result.load_before, 1);
    result.renderer = context.renderer();
    result.threads = thread_count();
    return result;
}

void time_all_frames(SpeedLedger& result,
                     const TimedScene& scene,
                     bool quick,
                     const Progress& progress) {
    SmallTimes smalls;
    for (const auto& [width, height] : {std::pair(640, 400), std::pair(1280, 800)}) {
        const View view = resized(scene.projector, width, height);
        for (const TimedLevels& levels : timed_levels(quick)) {
            time_frames(result, smalls, scene, view, levels, progress);
        }
    }
    if (quick) result.pass_costs.clear();
}

}  // namespace

SpeedLedger measure_speed(GlDevice device, bool quick, const Progress& progress) {
    const HeadlessContext context(device);
    SpeedLedger result = described(context);
    const TimedScene scene = load_scene(result, progress);
    result.sweep = run_speed_sweep(scene.product, scene.looks, scene.projector, quick, progress);
    time_all_frames(result, scene, quick, progress);
    if (quick) return result;
    compare_with_reference(result, scene, progress);
    result.effects.push_back(measure_first_frame(progress));
    // Last: it lowers the priority of helping threads for good.
    for (LedgerEffect& desktop : measure_desktop(device, progress)) {
        result.effects.push_back(std::move(desktop));
    }
    return result;
}

PassCosts costs_of(const SpeedLedger& ledger) {
    return {ledger.pass_costs, CostOrigin::measured, ledger.renderer, ledger.threads};
}

PassCosts measure_costs(GlDevice device, const Progress& progress) {
    const HeadlessContext context(device);
    SpeedLedger result = described(context);
    const TimedScene scene = load_scene(result, progress);
    time_all_frames(result, scene, false, progress);
    return costs_of(result);
}

PassCosts measure_machine(GlDevice device, const Progress& progress) {
    constexpr int kSwaps = 9;
    const HeadlessContext context(device);
    const PassCosts shipped = shipped_pass_costs();
    SpeedLedger unused;
    const TimedScene scene = load_scene(unused, progress);
    const View view = resized(scene.projector, 640, 400);
    const EffectLevels levels = levels_of(Quality::normal);
    RadianceRenderer renderer(std::make_shared<const FrameGeometry>(
        scene.product, view, progress, sub_samples_of(levels)));
    PassRatios ratios;
    for (int k = 0; k < kSwaps; ++k) {
        progress.update(static_cast<double>(k) / kSwaps, "drawing");
        const Scene& look = scene.looks[static_cast<std::size_t>(k) % scene.looks.size()];
        FramePlan plan = plan_frame(look, levels, FrameStage::radiance);
        renderer.render(look, plan, progress);
        add_ratios(ratios, plan, shipped.passes);
    }
    const auto scaled = scaled_costs(shipped, ratios);
    if (!scaled) throw std::logic_error("nothing of the frame was timed");
    PassCosts costs = *scaled;
    costs.renderer = context.renderer();
    return costs;
}

}  // namespace livery
