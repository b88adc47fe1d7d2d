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
    double work_items = 0.0;   ///< fragments, rays or pixels: what its cost is linear in; 0 unknown
    std::optional<double> ms;  ///< measured, after a render
    std::optional<double> predicted_ms;     ///< from the last bench on this machine
    std::optional<double> predicted_error;  ///< same
    std::string unpredicted_because;        ///< when there is no prediction
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

// Names of passes. One of each light is named by light_name(): key, fill, light-3, ...
inline constexpr const char* kSurfaceMapPass = "surface-map";
inline constexpr const char* kIrradiancePass = "environment-irradiance";
inline constexpr const char* kOcclusionPass = "ambient-occlusion";
inline constexpr const char* kFilterPass = "environment-filter";
inline constexpr const char* kReflectionPass = "reflection-occlusion";
inline constexpr const char* kMirrorPass = "mirrored-environment";
inline constexpr const char* kDirectionsPass = "directions";
inline constexpr const char* kDiffuseLightPass = "diffuse-light";
inline constexpr const char* kReliefPass = "relief";
inline constexpr const char* kArtworkPass = "artwork";
inline constexpr const char* kGlintPlacesPass = "glint-places";
inline constexpr const char* kResolvePass = "resolve";
inline constexpr const char* kCompensationPass = "compensation";
inline constexpr const char* kPathTracerPass = "path-tracer";
std::string light_name(std::size_t light);
std::string visibility_pass(std::size_t light);  ///< "key-visibility"
/// "shade:body:ggx", and "shade:body:car-paint+glints" where single flakes are seen.
std::string shade_pass(const Scene& scene, std::size_t part);
/// Of the scene's k-th artwork: "shade:body:artwork-1:clearcoat", and "+glints" alike.
std::string artwork_pass(const Scene& scene, std::size_t artwork);

/// The pass of that name, or null.
const PlannedPass* find_pass(const FramePlan& plan, const std::string& name);
PlannedPass* find_pass(FramePlan& plan, const std::string& name);

/// Lists passes with the reason and skipped ones with theirs. Nothing that is not in the plan is
/// compiled, allocated or run.
FramePlan plan_frame(const Scene& scene, Quality quality, FrameStage stage);

}  // namespace livery
