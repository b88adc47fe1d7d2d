// Which passes a scene calls for, which it does not, and why: a pure function of its input.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scene/scene.h"

namespace livery {

enum class Quality { draft, normal, high, reference };
Quality parse_quality(const std::string& text);  ///< throws std::invalid_argument with the names
std::string to_string(Quality quality);

struct PlannedPass {
    std::string name;  ///< "surface-map", "key-visibility", "shade:body:ggx", ...
    std::string why;
    double work_items = 0.0;  ///< fragments, rays or pixels: what its cost is linear in; 0 unknown
    std::optional<double> ms;              ///< measured, after a render
    std::optional<double> predicted_ms;    ///< from the last bench on this machine
    std::optional<double> predicted_error; ///< same
    std::string unpredicted_because;       ///< when there is no prediction
};

struct SkippedPass {
    std::string name;
    std::string why;
};

struct FramePlan {
    Quality quality = Quality::normal;
    std::vector<PlannedPass> passes;
    std::vector<SkippedPass> skipped;
};

/// What stage of the chain the frame must reach.
enum class FrameStage { radiance, projector };

/// Lists passes with the reason and skipped ones with theirs. Nothing that is not in the plan is
/// compiled, allocated or run.
FramePlan plan_frame(const Scene& scene, Quality quality, FrameStage stage);

}  // namespace livery
