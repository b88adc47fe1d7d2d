#include "ledger/accuracy/rows.h"

#include <algorithm>
#include <chrono>
#include <map>

#include "core/pictures/picture_means.h"
#include "core/statistics.h"
#include "radiance/renderer.h"
#include "scene/frame_plan.h"

namespace livery {

namespace {

constexpr int kSwaps = 5;

/// The truth draws flakes as the smooth lobe that many of them are: pictures with single flakes in
/// them would show nothing else.
EffectLevels comparable(EffectLevels levels, const AccuracyScene& scene) {
    if (calls_for(scene.scene, Effect::glints)) levels[Effect::glints] = 0;
    return levels;
}

}  // namespace

std::vector<AccuracyRow> rows_to_measure(const std::vector<AccuracyScene>& scenes) {
    std::vector<AccuracyRow> rows;
    for (const AccuracyScene& scene : scenes) {
        for (const Quality quality : {Quality::draft, Quality::normal, Quality::high}) {
            AccuracyRow& row = rows.emplace_back();
            row.scene = scene.name;
            row.effect = kQualityRows;
            row.level = to_string(quality);
            row.index = static_cast<int>(quality);
            row.levels = comparable(levels_of(quality), scene);
            row.called_for = !scene.only;
        }
        for (const EffectInfo& info : effect_table()) {
            for (std::size_t k = 0; k < info.levels.size(); ++k) {
                AccuracyRow& row = rows.emplace_back();
                row.scene = scene.name;
                row.effect = info.name;
                row.level = info.levels[k].name;
                row.index = static_cast<int>(k);
                row.levels = comparable(dearest_levels(), scene);
                row.levels[info.effect] = row.index;
                row.called_for = calls_for(scene.scene, info.effect) &&
                                 scene.only.value_or(info.effect) == info.effect;
            }
        }
    }
    return rows;
}

struct RowMeasurement::State {
    const AccuracyScene& scene;
    const Truth& truth;
    std::map<int, std::shared_ptr<const FrameGeometry>> geometries;  ///< by sub-samples

    std::shared_ptr<const FrameGeometry> geometry(int sub_samples, const Progress& progress) {
        auto& known = geometries[sub_samples];
        if (!known) {
            known = std::make_shared<const FrameGeometry>(
                scene.scene.product, scene.view, progress, sub_samples);
        }
        return known;
    }
};

RowMeasurement::RowMeasurement(const AccuracyScene& scene, const Truth& truth)
    : state_(std::make_unique<State>(scene, truth)) {}
RowMeasurement::~RowMeasurement() = default;

AccuracyRow RowMeasurement::measured(const AccuracyRow& row, const Progress& progress) {
    State& s = *state_;
    AccuracyRow result = row;
    Scene scene = s.scene.scene;
    RadianceRenderer renderer(s.geometry(sub_samples_of(row.levels), progress));
    FramePlan plan = plan_frame(scene, row.levels, FrameStage::radiance);
    renderer.render(scene, plan, progress);
    for (const PlannedPass& pass : plan.passes) {
        const double ms = pass.ms.value_or(0.0);
        if (!runs_every_frame(pass.id)) result.solve_ms += ms;
        const auto effect = effect_of(pass.id);
        if (effect && effect_info(*effect).name == row.effect) result.own_ms += ms;
    }
    result.fragments = static_cast<double>(renderer.surface_map().fragments.size());
    const std::vector<float> apart = colour_differences(
        square_means(renderer.read_back(), s.scene.mean_px), s.truth.radiance_working);
    result.error = statistics_of(apart);
    result.p99 = static_cast<double>(quantile(apart, 0.99));
    result.floor_median = s.truth.floor.median;
    result.floor_p95 = s.truth.floor.p95;
    result.floor_p99 = s.truth.p99;

    std::vector<double> swaps;
    for (int k = 0; k < kSwaps; ++k) {
        progress.check_stop();
        // Another exposure shades every part anew, and nothing else
        scene.exposure_ev += 0.01;
        FramePlan again = plan_frame(scene, row.levels, FrameStage::radiance);
        const auto start = std::chrono::steady_clock::now();
        renderer.render(scene, again, progress);
        renderer.picture();
        swaps.push_back(
            std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start)
                .count());
    }
    result.swap_ms = median(swaps);
    return result;
}

}  // namespace livery
