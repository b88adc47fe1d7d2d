#include "live/frame_description.h"

#include <stdexcept>
#include <utility>

#include <glm/common.hpp>

#include "appearance/paint_bsdf.h"
#include "appearance/parameter_table.h"
#include "appearance/subsurface/translucent_paint.h"
#include "core/error.h"
#include "scene/effects.h"

namespace livery {

namespace {

/// Of an albedo of 1.
constexpr float kSteps = 64.0f;

std::vector<glm::ivec3> sends_on(const Scene& scene, const EffectLevels& levels) {
    if (!sends_light_on(scene, levels)) return {};
    std::vector<glm::ivec3> steps;
    for (const Material& material : scene.part_materials) {
        const glm::vec3 albedo = hemispherical_albedo(bsdf_of(material));
        steps.emplace_back(glm::round(kSteps * albedo));
    }
    return steps;
}

std::vector<std::vector<double>> media_of(const Scene& scene, const EffectLevels& levels) {
    if (levels[Effect::subsurface] == 0) return {};
    std::vector<std::vector<double>> media;
    for (std::size_t p = 0; p < scene.part_materials.size(); ++p) {
        const Material& paint = scene.part_materials[p];
        if (!light_spreads(paint, scene.product->product_scale)) continue;
        // The surface's gloss is no part of it
        Material smooth = paint;
        smooth.alpha = glm::dvec2(kSmoothAlpha);
        media.push_back(reflectance_numbers(smooth));
        media.back().push_back(static_cast<double>(p));
    }
    return media;
}

std::string difference(const SolveKey& solved, const SolveKey& wanted) {
    if (solved.product != wanted.product) return "product";
    if (solved.view != wanted.view) return "projector";
    if (solved.environment != wanted.environment) return "environment";
    if (solved.lights != wanted.lights) return "light";
    if (solved.eye_mm != wanted.eye_mm) return "eye";
    if (!same_relief(solved.relief, wanted.relief)) return "relief";
    if (solved.levels != wanted.levels) {
        const Quality quality = nearest_quality(wanted.levels);
        return wanted.levels == levels_of(quality) ? to_string(quality) + " quality" : "levels";
    }
    return "";
}

SolveKeys keys_of(const FrameDescription& description) {
    check_argument(description.setup != nullptr, "the frame has no projector");
    const EffectLevels levels =
        description.levels ? *description.levels : levels_of(description.quality);
    const auto key_of = [&](const Scene& scene) {
        check_argument(scene.product != nullptr, "the frame has no product");
        return SolveKey{scene.product,
                        description.setup->view,
                        scene.environment,
                        scene.lights,
                        scene.eye_in_world_mm,
                        levels,
                        scene.relief,
                        sends_on(scene, levels),
                        media_of(scene, levels)};
    };
    SolveKeys keys{key_of(description.scene), std::nullopt};
    if (description.wipe_to) {
        keys[1] = key_of(*description.wipe_to);
        check_argument(keys[0]->product == keys[1]->product,
                       "a wipe shows two looks of one product, these are of two");
    }
    return keys;
}

}  // namespace

WantedFrame::WantedFrame(FrameDescription description) : FrameDescription(std::move(description)) {
    try {
        keys = keys_of(*this);
    } catch (const std::invalid_argument& error) {
        malformed = error.what();
    }
}

SolveKeys with_levels(SolveKeys keys, const EffectLevels& levels) {
    for (auto& key : keys) {
        if (!key) continue;
        key->levels = levels;
        if (levels[Effect::interreflection] == 0) key->sends_on.clear();
        if (levels[Effect::subsurface] == 0) key->media.clear();
    }
    return keys;
}

bool same_pose(const SolveKey& a, const SolveKey& b) {
    return a.product == b.product && a.view == b.view;
}

bool same_light(const SolveKey& a, const SolveKey& b) {
    return same_pose(a, b) && a.environment == b.environment && a.lights == b.lights &&
           a.eye_mm == b.eye_mm && same_relief(a.relief, b.relief);
}

bool serves_both(const SolveKey& a, const SolveKey& b) {
    return same_light(a, b) && a.sends_on == b.sends_on && a.media == b.media;
}

std::size_t nearest_of(const SolveKeys& solved, const SolveKeys& wanted, std::size_t side) {
    const SolveKey& own = *wanted[side];
    if (!solved[1]) return 0;
    for (const auto serves : {serves_both, same_light}) {
        for (const std::size_t candidate : {side, 1 - side}) {
            if (serves(*solved[candidate], own)) return candidate;
        }
    }
    return side;
}

std::string missing_of(const SolveKeys& solved, const SolveKeys& wanted) {
    for (std::size_t side = 0; side < wanted.size(); ++side) {
        if (!wanted[side]) continue;
        if (!solved[0]) return "picture";
        const SolveKey& nearest = *solved[nearest_of(solved, wanted, side)];
        const std::string missing = difference(nearest, *wanted[side]);
        if (!missing.empty()) return missing;
        if (nearest.sends_on != wanted[side]->sends_on) return "light between parts";
        if (nearest.media != wanted[side]->media) return "light in translucent parts";
    }
    return "";
}

bool covers_light(const SolveKeys& solved, const SolveKeys& wanted) {
    const EffectLevels draft = levels_of(Quality::draft);
    return solved[0] && missing_of(with_levels(solved, draft), with_levels(wanted, draft)).empty();
}

}  // namespace livery
