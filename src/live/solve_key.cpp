#include "live/solve_key.h"

#include <algorithm>

#include "core/error.h"

namespace livery {

namespace {

std::string difference(const SolveKey& solved, const SolveKey& wanted) {
    if (solved.product != wanted.product) return "product";
    if (solved.view != wanted.view) return "projector";
    if (solved.environment != wanted.environment) return "environment";
    if (solved.lights != wanted.lights) return "light";
    if (solved.eye_mm != wanted.eye_mm) return "eye";
    if (!same_relief(solved.relief, wanted.relief)) return "relief";
    if (solved.quality != wanted.quality) return to_string(wanted.quality) + " quality";
    return "";
}

}  // namespace

SolveKeys keys_of(const FrameDescription& description) {
    check_argument(description.setup != nullptr, "the frame has no projector");
    const auto key_of = [&](const Scene& scene) {
        check_argument(scene.product != nullptr, "the frame has no product");
        return SolveKey{scene.product,
                        description.setup->view,
                        scene.environment,
                        scene.lights,
                        scene.eye_in_world_mm,
                        description.quality,
                        scene.relief};
    };
    SolveKeys keys{key_of(description.scene), std::nullopt};
    if (description.wipe_to) {
        keys[1] = key_of(*description.wipe_to);
        check_argument(keys[0]->product == keys[1]->product,
                       "a wipe shows two looks of one product, these are of two");
    }
    return keys;
}

SolveKeys with_quality(SolveKeys keys, Quality quality) {
    for (auto& key : keys) {
        if (key) key->quality = quality;
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

std::size_t nearest_of(const SolveKeys& solved, const SolveKeys& wanted, std::size_t side) {
    const SolveKey& own = *wanted[side];
    if (!solved[1]) return 0;
    for (const std::size_t candidate : {side, 1 - side}) {
        if (same_light(*solved[candidate], own)) return candidate;
    }
    return side;
}

std::string missing_of(const SolveKeys& solved, const SolveKeys& wanted) {
    for (std::size_t side = 0; side < wanted.size(); ++side) {
        if (!wanted[side]) continue;
        if (!solved[0]) return "picture";
        const std::string missing =
            difference(*solved[nearest_of(solved, wanted, side)], *wanted[side]);
        if (!missing.empty()) return missing;
    }
    return "";
}

bool covers_light(const SolveKeys& solved, const SolveKeys& wanted) {
    return solved[0] &&
           missing_of(with_quality(solved, Quality::normal), with_quality(wanted, Quality::normal))
               .empty();
}

}  // namespace livery
