// Which passes a scene calls for, which it does not, and why: a pure function of its input.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scene/pass_id.h"
#include "scene/scene.h"

namespace livery {

enum class Quality { draft, normal, high, reference };
Quality parse_quality(const std::string& text);  ///< throws std::invalid_argument with the names
std::string to_string(Quality quality);

struct PlannedPass {
    PassId id;
    std::string why;
    double work_items = 0.0;   ///< fragments, rays or pixels: what its cost is linear in; 0 unknown
    std::optional<double> ms;  ///< measured, after a render
    std::optional<double> predicted_ms;     ///< from the last bench on this machine
    std::optional<double> predicted_error;  ///< same
    std::string unpredicted_because;        ///< when there is no prediction
};

struct SkippedPass {
    PassId id;
    std::string why;
};

struct FramePlan {
    Quality quality = Quality::normal;
    std::vector<PlannedPass> passes;
    std::vector<SkippedPass> skipped;
};

/// What stage of the chain the frame must reach.
enum class FrameStage { radiance, projector };

PassId visibility_pass(std::size_t light);
/// With glints where single flakes are seen.
PassId shade_pass(const Scene& scene, std::size_t part);
/// Of the scene's k-th artwork, over the paint of its part.
PassId artwork_pass(const Scene& scene, std::size_t artwork);

/// That pass of the plan, or null.
const PlannedPass* find_pass(const FramePlan& plan, const PassId& id);
PlannedPass* find_pass(FramePlan& plan, const PassId& id);

/// Lists passes with the reason and skipped ones with theirs. Nothing that is not in the plan is
/// compiled, allocated or run.
FramePlan plan_frame(const Scene& scene, Quality quality, FrameStage stage);

}  // namespace livery
