// What the mock-up is to show, and what of it takes long to solve and stands while paints change.
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "appearance/material_library.h"
#include "live/projector_setup.h"
#include "scene/frame_plan.h"
#include "scene/scene.h"

namespace livery {

/// What the mock-up is to show: one immutable value.
struct FrameDescription {
    std::uint64_t number = 0;  ///< rises
    Scene scene;
    std::optional<Scene> wipe_to;  ///< shown right of `wipe_at`
    double wipe_at = 0.5;          ///< fraction of the mock-up's width in the projector's picture
    std::optional<int> glowing_part;  ///< clicked in the preview: glows on the mock-up
    Quality quality = Quality::normal;
    std::optional<EffectLevels> levels;  ///< chosen one by one; none: the quality's
    /// At finer levels than a next light will be asked for: only what is shown is solved, not the
    /// lane behind it.
    bool refined = false;
    double fade_s = 0.0;  ///< how long each picture of it takes to come
    std::shared_ptr<const ProjectorSetup> setup;
    std::shared_ptr<const PaintLibrary> library;       ///< what is likely to be next; null: nothing
    std::chrono::steady_clock::time_point asked_at{};  ///< of the input that caused it
};

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

/// A description with the keys that its lights are solved for: made once, by who asks for the
/// frame, and read by everything after.
struct WantedFrame : FrameDescription {
    WantedFrame(FrameDescription description);  // NOLINT: a description is what is wanted

    SolveKeys keys;
    /// Why it cannot be drawn: it lacks a product or a projector, or wipes between two products.
    /// Empty: it can, and has keys.
    std::string malformed;

    std::size_t sides() const { return wipe_to ? 2 : 1; }
    const Scene& side(std::size_t index) const { return index == 0 ? scene : *wipe_to; }
};

}  // namespace livery
