// Which passes a scene calls for, which it does not, and why: a pure function of its input. A pass
// is a value that plans, renderers, costs and panels compare.
#pragma once

#include <compare>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "appearance/material.h"
#include "scene/effects.h"
#include "scene/scene.h"

namespace livery {

/// In the order in which a plan lists them.
enum class PassKind {
    path_tracer,
    surface_map,
    relief,
    light_visibility,
    environment_irradiance,
    ambient_occlusion,
    interreflection,
    subsurface,
    environment_filter,
    reflection_occlusion,
    mirrored_environment,
    directions,
    diffuse_light,
    artwork,
    glint_places,
    shade,
    resolve,
    compensation,
    prepare,  ///< for a paint that may be next, ahead of its frame
};

struct PassId {
    PassKind kind = PassKind::surface_map;
    std::string part;                       ///< that is shaded; empty: any
    std::optional<ReflectanceModel> model;  ///< that shades, or is prepared
    bool glints = false;                    ///< and single flakes
    std::optional<std::size_t> artwork;     ///< of the scene, that is shaded over the part
    std::optional<std::size_t> light;       ///< of the scene, that is seen; none: any
    std::optional<PassKind> ahead;          ///< that is prepared: more of it than the frame reads

    /// A kind stands for its pass where it has but one.
    PassId(PassKind its_kind = PassKind::surface_map,
           std::string its_part = "",
           std::optional<ReflectanceModel> its_model = std::nullopt,
           bool its_glints = false)
        : kind(its_kind), part(std::move(its_part)), model(its_model), glints(its_glints) {}
    auto operator<=>(const PassId&) const = default;
};

/// For people and in JSON: "surface-map", "key-visibility", "shade:body:car-paint+glints",
/// "shade:body:artwork-1:clearcoat", "prepare:ggx", "prepare:mirrored-environment".
std::string to_string(const PassId& pass);
std::string light_name(std::size_t light);  ///< key, fill, light-3, ...

struct PlannedPass {
    PassId id;
    std::string why;           ///< say_why()
    double work_items = 0.0;   ///< fragments, rays or pixels: what its cost is linear in; 0 unknown
    std::optional<double> ms;  ///< measured, after a render
    std::optional<double> predicted_ms;     ///< from what passes cost
    std::optional<double> predicted_error;  ///< same
    std::string unpredicted_because;        ///< when there is no prediction
};

struct SkippedPass {
    PassId id;
    std::string why;  ///< say_why()
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

/// Lists the passes that run and those that are skipped. Nothing that is not in the plan is
/// compiled, allocated or run. Throws std::invalid_argument for levels that there are not.
FramePlan plan_frame(const Scene& scene, const EffectLevels& levels, FrameStage stage);
/// At that quality's levels, or by the path tracer.
FramePlan plan_frame(const Scene& scene, Quality quality, FrameStage stage);

/// Fills in why each pass runs or is skipped, where nobody has said so yet: for who shows the plan.
void say_why(const Scene& scene, FramePlan& plan);

/// Whether the plan would have PassKind::interreflection.
bool sends_light_on(const Scene& scene, const EffectLevels& levels);

/// What light that parts send to one another may add, were nothing between them: the largest share
/// of a place's own light, and that as CIEDE2000.
struct ExchangeBound {
    std::size_t part = 0;  ///< where it is largest
    double share = 0.0;
    double de00 = 0.0;
};
ExchangeBound exchange_bound(const Scene& scene);

}  // namespace livery
