// What of a frame description takes long to solve, and stands while paints change.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "live/frame_thread.h"
#include "scene/frame_plan.h"

namespace livery {

struct SolveKey {
    std::shared_ptr<const Product> product;
    View view;
    std::shared_ptr<const Environment> environment;
    std::vector<DirectionalLight> lights;
    glm::dvec3 eye_mm{0.0};
    EffectLevels levels{};
    std::vector<PartArtwork> relief{};
    /// What each part sends on of its light, in steps that nobody sees; empty: no light between
    /// parts is asked for.
    std::vector<glm::ivec3> sends_on{};
    /// The paint of each part in which light spreads, as numbers; empty: none that is asked for.
    std::vector<std::vector<double>> media{};
};
/// Of the scene left of a wipe's line (or of all) and of the one right of it. What is solved has a
/// right one only where its light differs from the left one's.
using SolveKeys = std::array<std::optional<SolveKey>, 2>;

/// Throws std::invalid_argument when the description lacks a product or a projector, or wipes
/// between two products.
SolveKeys keys_of(const FrameDescription& description);
SolveKeys with_levels(SolveKeys keys, const EffectLevels& levels);

bool same_pose(const SolveKey& a, const SolveKey& b);  ///< product and projector
/// All but levels, what parts send on and what they are made of.
bool same_light(const SolveKey& a, const SolveKey& b);
/// Whether what is solved for one is what the other needs: same light, and paints that send on and
/// scatter as much of it.
bool serves_both(const SolveKey& a, const SolveKey& b);

/// Which of `solved` to draw a side of `wanted` with: its own light if that is there, else the
/// nearest thing. `solved` has at least a left one.
std::size_t nearest_of(const SolveKeys& solved, const SolveKeys& wanted, std::size_t side);

/// What is solved otherwise than it is wanted: "light", "environment", "eye", "normal quality",
/// "levels", "light between parts", "light in translucent parts", ... Empty when nothing is. Sides
/// of a wipe that share their light share the left one's light between parts.
std::string missing_of(const SolveKeys& solved, const SolveKeys& wanted);
/// The same, levels and light between and in parts aside.
bool covers_light(const SolveKeys& solved, const SolveKeys& wanted);

}  // namespace livery
