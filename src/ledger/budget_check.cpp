#include "ledger/budget_check.h"

#include <algorithm>
#include <limits>
#include <memory>

#include <fmt/format.h>

#include "appearance/material_library.h"
#include "core/error.h"
#include "core/random.h"
#include "core/statistics.h"
#include "ledger/accuracy/truth.h"
#include "ledger/budget.h"
#include "radiance/renderer.h"
#include "scene/library.h"
#include "twin/description.h"

namespace livery {

namespace {

constexpr int kScenes = 20, kQuickScenes = 5, kRounds = 3;
constexpr int kSamples = 64;  ///< a pixel of each of the two pictures that a choice is judged by

/// From nothing: the surface map too.
double first_frame_ms(const Scene& scene,
                      const View& view,
                      const EffectLevels& levels,
                      const Progress& progress) {
    RadianceRenderer renderer(std::make_shared<const FrameGeometry>(
        scene.product, view, progress, sub_samples_of(levels)));
    FramePlan plan = plan_frame(scene, levels, FrameStage::radiance);
    renderer.render(scene, plan, progress);
    double sum = 0.0;
    for (const PlannedPass& pass : plan.passes) sum += pass.ms.value_or(0.0);
    return sum;
}

struct RandomFrame {
    std::string name;
    Scene scene;
    View view;
    EffectLevels levels;
};

std::vector<RandomFrame> random_frames(int count, std::uint64_t seed, const Progress& progress) {
    Random random(seed);
    const auto between = [&](double low, double high) {
        return low + (high - low) * random.uniform();
    };
    const std::vector<std::string> names = shipped_looks();
    std::vector<RandomFrame> frames;
    for (int k = 0; k < count; ++k) {
        progress.check_stop();
        const std::string product_name = random.below(4) == 0 ? "player" : "car";
        const auto product = find_product(product_name);
        const BenchDescription bench = read_bench_file(*bench_of_shipped_product(product_name));
        Look look = find_look_for("solid-red", product->mesh);
        std::string shown = "its own look";
        if (product_name == "car") {
            shown = names[random.below(static_cast<std::uint32_t>(names.size()))];
            look = find_look(shown);
        }
        for (DirectionalLight& light : look.lights) {
            light.direction =
                unit_direction({between(-1.0, 1.0), between(0.2, 1.0), between(-1.0, 1.0)});
        }
        look.environment.rotation_rad = between(-3.0, 3.0);
        RandomFrame& frame = frames.emplace_back();
        const glm::dvec3 eye_mm =
            bench.eye_mm +
            glm::dvec3(between(-400.0, 400.0), between(-200.0, 200.0), between(-400.0, 400.0));
        frame.scene = make_scene(product, look, eye_mm);
        const double scale = between(0.4, 1.0);
        const View& whole = bench.projector.view;
        frame.view = resized(
            whole, static_cast<int>(scale * whole.width), static_cast<int>(scale * whole.height));
        for (const EffectInfo& info : effect_table()) {
            frame.levels[info.effect] =
                static_cast<int>(random.below(static_cast<std::uint32_t>(info.levels.size())));
        }
        frame.name =
            fmt::format("{}, {}, {}x{}", product_name, shown, frame.view.width, frame.view.height);
    }
    return frames;
}

std::vector<PredictedFrame> predict_and_time(const std::vector<PassCost>& costs,
                                             int count,
                                             std::uint64_t seed,
                                             const Progress& progress) {
    const std::vector<RandomFrame> frames = random_frames(count, seed, progress);
    std::vector<PredictedFrame> result;
    std::vector<std::vector<double>> measured(frames.size());
    for (const RandomFrame& frame : frames) {
        const PriceList list = make_price_list(
            frame.scene, FrameStage::radiance, covered_areas(frame.scene, frame.view), costs, {});
        const PredictedTime time = time_of(list, frame.levels);
        if (!time.complete) {
            throw Refused("nobody has timed every pass of " + frame.name,
                          "run livery bench --suite costs");
        }
        result.push_back({frame.name, frame.levels, time.all_ms, 0.0});
    }
    // One after the other, and again: what disturbs the machine for a while disturbs all alike
    for (int round = 0; round < kRounds; ++round) {
        for (std::size_t k = 0; k < frames.size(); ++k) {
            progress.update(
                static_cast<double>(round * count + static_cast<int>(k)) / (kRounds * count),
                "timing " + frames[k].name);
            measured[k].push_back(first_frame_ms(
                frames[k].scene, frames[k].view, frames[k].levels, Progress{{}, progress.stop}));
        }
    }
    for (std::size_t k = 0; k < frames.size(); ++k) result[k].measured_ms = median(measured[k]);
    return result;
}

/// Car and sphere in one paint, with lamps or an environment alone: four effects at work at most.
std::vector<AccuracyScene> simple_scenes() {
    Material matt;
    matt.name = "matt red";
    matt.model = ReflectanceModel::lambert;
    matt.diffuse = {0.5, 0.1, 0.08};
    std::vector<AccuracyScene> scenes;
    const auto add = [&](const char* product_name, const Material& paint, bool lamps, bool sky) {
        const auto product = find_product(product_name);
        const BenchDescription bench = read_bench_file(*bench_of_shipped_product(product_name));
        Look look = find_look_for("solid-red", product->mesh);
        if (!lamps) look.lights.clear();
        if (!sky) look.environment.file.clear();
        AccuracyScene& scene = scenes.emplace_back();
        scene.name =
            fmt::format("{}, {}, {}", product_name, paint.name, lamps ? "lamps" : "environment");
        scene.scene = make_scene(product, look, bench.eye_mm);
        for (Material& worn : scene.scene.part_materials) worn = paint;
        scene.view = resized(bench.projector.view, 240, 150);
    };
    const Material satin = find_material("satin white");
    add("sphere", matt, true, false);
    add("sphere", matt, false, true);
    add("car", matt, true, false);
    add("car", satin, true, false);
    add("car", matt, false, true);
    return scenes;
}

ChosenLevels judge_choice(const AccuracyScene& scene,
                          const std::vector<PassCost>& costs,
                          std::uint64_t seed,
                          const Progress& progress) {
    TruthOptions options;
    options.samples_per_pixel = kSamples;
    options.seed = seed;
    const Truth truth = truth_of(scene, options, progress.part(0.0, 0.3));
    const PriceList list = make_price_list(scene.scene,
                                           FrameStage::radiance,
                                           covered_areas(scene.scene, scene.view),
                                           costs,
                                           known_effect_errors());
    ChosenLevels result;
    result.scene = scene.name;
    result.floor = truth.floor.p95;
    result.budget_ms = 0.5 * time_of(list, dearest_levels()).all_ms;
    const EffectLevels chosen = levels_within(list, {result.budget_ms, {}});
    result.predicted = error_of(list, chosen);
    const std::vector<EffectLevels> all = combinations(list);
    result.best = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < all.size(); ++k) {
        progress.update(0.3 + 0.7 * static_cast<double>(k) / static_cast<double>(all.size()),
                        "drawing every combination: " + scene.name);
        if (time_of(list, all[k]).all_ms > result.budget_ms) continue;
        ++result.combinations;
        RadianceRenderer renderer(std::make_shared<const FrameGeometry>(
            scene.scene.product, scene.view, Progress{{}, progress.stop}, sub_samples_of(all[k])));
        FramePlan plan = plan_frame(scene.scene, all[k], FrameStage::radiance);
        renderer.render(scene.scene, plan, Progress{{}, progress.stop});
        const double error =
            statistics_of(colour_differences(renderer.read_back(), truth.radiance_working)).p95;
        result.best = std::min(result.best, error);
        if (all[k] == chosen) result.chosen = error;
    }
    return result;
}

std::vector<double> ratios_of(const BudgetCheck& check) {
    std::vector<double> ratios;
    for (const PredictedFrame& frame : check.frames) {
        ratios.push_back(frame.predicted_ms / frame.measured_ms);
    }
    return ratios;
}

std::string summary(const BudgetCheck& check) {
    const std::vector<double> ratios = ratios_of(check);
    const auto within = std::count_if(
        ratios.begin(), ratios.end(), [](double ratio) { return ratio >= 0.75 && ratio <= 1.25; });
    return fmt::format(
        "Predicted over measured, {} random frames: median {:.2f}, from {:.2f} to "
        "{:.2f}; {} within 25%.",
        ratios.size(),
        median(ratios),
        *std::min_element(ratios.begin(), ratios.end()),
        *std::max_element(ratios.begin(), ratios.end()),
        within);
}

}  // namespace

BudgetCheck check_budget(GlDevice device,
                         bool quick,
                         std::uint64_t seed,
                         const Progress& progress) {
    const std::vector<PassCost> costs = known_pass_costs().passes;
    const HeadlessContext context(device);
    BudgetCheck check;
    check.renderer = context.renderer();
    check.frames =
        predict_and_time(costs, quick ? kQuickScenes : kScenes, seed, progress.part(0.0, 0.5));
    std::vector<AccuracyScene> scenes = simple_scenes();
    if (quick) scenes.resize(1);
    for (std::size_t k = 0; k < scenes.size(); ++k) {
        const double step = 0.5 / static_cast<double>(scenes.size());
        const double from = 0.5 + step * static_cast<double>(k);
        check.choices.push_back(
            judge_choice(scenes[k], costs, seed, progress.part(from, from + step)));
    }
    return check;
}

std::vector<LedgerEffect> effects_of(const BudgetCheck& check) {
    LedgerEffect predicted{"predicted over measured first frame", {}},
        chosen{"error of the levels chosen for a budget", {}},
        best{"least error of all levels that fit it", {}};
    for (const PredictedFrame& frame : check.frames) {
        LedgerLevel level = level_of(frame.scene, {frame.measured_ms});
        level.error = frame.predicted_ms / frame.measured_ms;
        level.unit = "ratio";
        predicted.levels.push_back(level);
    }
    for (const ChosenLevels& choice : check.choices) {
        LedgerLevel level = level_of(choice.scene, {choice.budget_ms});
        level.unit = "CIEDE2000";
        level.error = choice.chosen;
        chosen.levels.push_back(level);
        level.error = choice.best;
        best.levels.push_back(level);
    }
    return {predicted, chosen, best};
}

std::string markdown_of(const BudgetCheck& check) {
    std::string text = fmt::format("OpenGL: {}. {}\n\n", check.renderer, summary(check));
    text += "| frame | predicted, ms | measured, ms | ratio |\n| --- | --- | --- | --- |\n";
    for (const PredictedFrame& frame : check.frames) {
        text += fmt::format("| {} | {:.0f} | {:.0f} | {:.2f} |\n",
                            frame.scene,
                            frame.predicted_ms,
                            frame.measured_ms,
                            frame.predicted_ms / frame.measured_ms);
    }
    text +=
        "\n| scene | budget, ms | combinations that fit | chosen, 95% | least of all, 95% | "
        "truth's floor, 95% |\n| --- | --- | --- | --- | --- | --- |\n";
    for (const ChosenLevels& choice : check.choices) {
        text += fmt::format("| {} | {:.0f} | {} | {:.2f} | {:.2f} | {:.2f} |\n",
                            choice.scene,
                            choice.budget_ms,
                            choice.combinations,
                            choice.chosen,
                            choice.best,
                            choice.floor);
    }
    return text;
}

}  // namespace livery
