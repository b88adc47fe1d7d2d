// Which passes a scene calls for, which it does not, and why: a pure function of its input.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scene/effects.h"
#include "scene/pass_id.h"
#include "scene/scene.h"

namespace livery {

struct PlannedPass {
    PassId id;
    std::string why;
    double work_items = 0.0;   ///< fragments, rays or pixels: what its cost is linear in; 0 unknown
    std::optional<double> ms;  ///< measured, after a render
    std::optional<double> predicted_ms;     ///< from what passes cost
    std::optional<double> predicted_error;  ///< same
    std::string unpredicted_because;        ///< when there is no prediction
};

struct SkippedPass {
    PassId id;
    std::string why;
    /// What leaving it out costs at most, as CIEDE2000 somewhere on the product; none: nothing, or
    /// not bounded.
    std::optional<double> error_bound{};
};
/// Of paints that no part wears: nothing that this scene could call for.
inline bool is_of_other_paints(const SkippedPass& pass) { return pass.id.kind == PassKind::shade; }

struct FramePlan {
    Quality quality = Quality::normal;  ///< the nearest to `levels`, or the path tracer's
    EffectLevels levels;                ///< unused by the path tracer
    std::vector<PlannedPass> passes;
    std::vector<SkippedPass> skipped;
};

/// What stage of the chain the frame must reach.
enum class FrameStage { radiance, projector };

/// Of which effect the pass is; none: it runs at any level of any.
std::optional<Effect> effect_of(const PassId& pass);

/// Runs with every paint swap; all others are solved once for a light, an eye and a pose.
bool runs_every_frame(const PassId& pass);

PassId visibility_pass(std::size_t light);
/// With glints where single flakes are seen.
PassId shade_pass(const Scene& scene, std::size_t part);
/// Of the scene's k-th artwork, over the paint of its part.
PassId artwork_pass(const Scene& scene, std::size_t artwork);

/// Whether mirrors look for parts, and know what these send: then they show something under lamps
/// alone, too.
bool parts_send_light(const FramePlan& plan);
/// What parts and roughnesses mirror that the scene does not wear: for the paint that may be next.
PassId mirrored_ahead_pass();
/// Moves that pass from those that the frame skips to those that run.
void plan_ahead(FramePlan& plan);

/// That pass of the plan, or null.
const PlannedPass* find_pass(const FramePlan& plan, const PassId& id);
PlannedPass* find_pass(FramePlan& plan, const PassId& id);

/// Lists passes with the reason and skipped ones with theirs. Nothing that is not in the plan is
/// compiled, allocated or run. Throws std::invalid_argument for levels that there are not.
FramePlan plan_frame(const Scene& scene, const EffectLevels& levels, FrameStage stage);
/// At that quality's levels, or by the path tracer.
FramePlan plan_frame(const Scene& scene, Quality quality, FrameStage stage);

/// What light that parts send to one another may add, were nothing between them: the largest share
/// of a place's own light, and that as CIEDE2000.
struct ExchangeBound {
    std::size_t part = 0;  ///< where it is largest
    double share = 0.0;
    double de00 = 0.0;
};
ExchangeBound exchange_bound(const Scene& scene);

}  // namespace livery
