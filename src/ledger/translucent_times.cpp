#include "ledger/translucent_times.h"

#include <chrono>

#include <fmt/format.h>

#include "appearance/subsurface/translucent_paint.h"
#include "scene/product.h"

namespace livery {

namespace {

constexpr int kTranslucentSwaps = 7;

struct Timed {
    double frame_ms = 0.0, pass_ms = 0.0;
};
Timed timed_frame(RadianceRenderer& renderer,
                  const Scene& scene,
                  const EffectLevels& levels,
                  const Progress& progress) {
    FramePlan plan = plan_frame(scene, levels, FrameStage::radiance);
    const auto start = std::chrono::steady_clock::now();
    renderer.render(scene, plan, progress);
    Timed timed;
    timed.frame_ms =
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
    if (const PlannedPass* pass = find_pass(plan, PassKind::subsurface)) {
        timed.pass_ms = pass->ms.value_or(0.0);
    }
    return timed;
}

}  // namespace

TranslucentTimes measure_translucent(RadianceRenderer& renderer,
                                     const Scene& scene,
                                     const EffectLevels& levels,
                                     const Progress& progress) {
    TranslucentTimes times;
    const auto body = static_cast<std::size_t>(part_index(*scene.product, "body"));
    const SurfaceMap& map = renderer.surface_map();
    times.body_fragments = static_cast<double>(map.part_begin[body + 1] - map.part_begin[body]);
    const TranslucentMaterial marble = read_translucent_material("marble");
    const TranslucentMaterial large =
        with_mean_free_path(marble, scene.product->product_scale * mean_free_path_mm(marble));
    const auto count = effect_info(Effect::subsurface).levels.size();
    times.pass_ms.resize(count);
    for (std::size_t level = 1; level < count; ++level) {
        EffectLevels own = levels;
        own[Effect::subsurface] = static_cast<int>(level);
        // What was solved of another level is not this one's
        timed_frame(renderer, scene, own, progress);
        Scene worn = scene;
        std::vector<double> swaps;
        std::vector<double> first;
        for (int k = 0; k <= kTranslucentSwaps; ++k) {
            progress.check_stop();
            TranslucentMaterial medium = large;
            medium.sigma_a_per_mm *= 1.0 + 0.1 * k;
            worn.part_materials[body] = translucent_paint(medium);
            const Timed timed = timed_frame(renderer, worn, own, progress);
            if (k == 0) {
                first.push_back(timed.frame_ms);
                continue;
            }
            swaps.push_back(timed.frame_ms);
            times.pass_ms[level].push_back(timed.pass_ms);
        }
        const std::string name = effect_info(Effect::subsurface).levels[level].name;
        for (auto& [list, ms] :
             {std::pair(&times.first_frames, first), std::pair(&times.swaps, swaps)}) {
            list->push_back(level_of(name, ms));
            list->back().work_items = times.body_fragments;
        }
    }
    return times;
}

}  // namespace livery
