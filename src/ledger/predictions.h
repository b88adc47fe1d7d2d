// What a frame will cost on this machine, and how far it will be from the truth: from costs that
// were timed and errors that were measured.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "core/progress.h"
#include "ledger/effect_errors.h"
#include "ledger/pass_costs.h"
#include "radiance/stages.h"
#include "scene/frame_plan.h"
#include "scene/view.h"

namespace livery {

/// How much of a picture each part covers, in pixels, counted by a coarse ray cast; a fragment a
/// pixel.
FrameCounts covered_areas(const Scene& scene, const View& view, const Progress& progress = {});
/// The same of a frame that was drawn, from its plan's work items.
FrameCounts covered_areas(const Scene& scene,
                          const FramePlan& drawn,
                          const std::vector<PassCost>& costs);

/// With as many fragments as the sub-samples of these levels led to when the bench ran; as they are
/// where it did not time those.
FrameCounts counts_at(FrameCounts areas,
                      const EffectLevels& levels,
                      const std::vector<PassCost>& costs);

/// Fills predicted_ms of passes that know their work items, and the reason where it stays empty.
/// Returns a note for people, empty when all is predicted.
std::string predict_times(FramePlan& plan, const std::vector<PassCost>& costs);

/// Fills predicted_error: of an effect's first pass what its level leaves, of the pass that ends
/// the frame all of it. CIEDE2000 at the 95th percentile.
void predict_errors(FramePlan& plan,
                    const std::array<bool, kEffects>& called_for,
                    const EffectErrors& errors);

/// Of all passes, and of those that run with every paint. `complete`: every one was predicted.
struct PredictedTime {
    double all_ms = 0.0, swap_ms = 0.0;
    bool complete = true;
};
PredictedTime predicted_time(const FramePlan& plan);

}  // namespace livery
