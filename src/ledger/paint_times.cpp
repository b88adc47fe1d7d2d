#include "ledger/paint_times.h"

#include <chrono>

#include <fmt/format.h>

#include "appearance/subsurface/translucent_paint.h"
#include "radiance/artwork_inputs.h"
#include "scene/product.h"

namespace livery {

namespace {

constexpr int kArtworkRepeats = 7;

struct ArtworkKind {
    std::string name;
    Artwork artwork;
};

std::vector<ArtworkKind> kinds() {
    std::vector<ArtworkKind> list;
    for (const ArtworkShape shape :
         {ArtworkShape::half, ArtworkShape::stripes, ArtworkShape::dots}) {
        Artwork artwork;
        artwork.shape = shape;
        artwork.place.centre_mm = {0.0, 30.0, 0.0};
        list.push_back({kArtworkShapes[static_cast<std::size_t>(shape)], artwork});
    }
    for (const PictureUse use : {PictureUse::cover, PictureUse::colours, PictureUse::roughness}) {
        Artwork artwork = list.front().artwork;
        artwork.shape = ArtworkShape::picture;
        artwork.picture = "assets/patterns/blossoms.png";
        artwork.use = use;
        artwork.repeat = true;
        list.push_back(
            {std::string("picture, ") + kPictureUses[static_cast<std::size_t>(use)], artwork});
    }
    return list;
}

double shading_ms(RadianceRenderer& renderer,
                  const Scene& scene,
                  const EffectLevels& levels,
                  double* cover_ms) {
    FramePlan plan = plan_frame(scene, levels, FrameStage::radiance);
    renderer.render(scene, plan);
    double sum = 0.0;
    for (const PlannedPass& pass : plan.passes) {
        if (pass.id.kind == PassKind::shade) sum += pass.ms.value_or(0.0);
        if (pass.id == PassKind::artwork && cover_ms) *cover_ms = pass.ms.value_or(0.0);
    }
    return sum;
}

double milliseconds(const auto& work) {
    const auto start = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start)
        .count();
}

}  // namespace

ArtworkTimes measure_artwork(RadianceRenderer& renderer,
                             const Scene& scene,
                             const EffectLevels& levels,
                             const Progress& progress) {
    const auto body = static_cast<std::size_t>(part_index(*scene.product, "body"));
    const Material& paint = scene.part_materials[body];
    const SurfaceMap& map = renderer.surface_map();
    ArtworkTimes result;
    result.body_fragments = static_cast<double>(map.part_begin[body + 1] - map.part_begin[body]);
    const auto wearing = [&](const Artwork& artwork) {
        const auto picture = artwork.picture.empty()
                                 ? nullptr
                                 : load_artwork_picture(find_artwork_picture(artwork.picture, ""));
        return make_part_artwork(body, artwork, paint, picture);
    };
    for (const ArtworkKind& kind : kinds()) {
        Scene with = scene;
        std::vector<double> more;
        for (int k = 0; k < kArtworkRepeats; ++k) {
            progress.check_stop();
            // Another place each time, so that its cover is solved; then another exposure, which
            // shades both anew and solves nothing.
            Artwork moved = kind.artwork;
            moved.place.centre_mm.y += 0.1 * k;
            with.artwork = {wearing(moved)};
            with.exposure_ev = scene.exposure_ev;
            double cover = 0.0;
            shading_ms(renderer, with, levels, &cover);
            result.cover_ms.push_back(cover);
            Scene bare = scene;
            bare.exposure_ev = with.exposure_ev = scene.exposure_ev + 0.01 * (k + 1);
            const double covered_ms = shading_ms(renderer, with, levels, nullptr);
            bare.exposure_ev += 0.005;
            more.push_back(covered_ms - shading_ms(renderer, bare, levels, nullptr));
        }
        LedgerLevel level = level_of(kind.name, more);
        level.work_items = result.body_fragments;
        result.frames.push_back(level);
    }
    Artwork relief;
    relief.shape = ArtworkShape::picture;
    relief.use = PictureUse::relief;
    relief.picture = "assets/patterns/weave.png";
    relief.repeat = true;
    Scene tilted = scene;
    tilted.relief = {wearing(relief)};
    for (int k = 0; k < 3; ++k) {
        progress.check_stop();
        result.relief_ms.push_back(
            milliseconds([&] { relieved(map, tilted, renderer.geometry()->view); }));
    }
    return result;
}

namespace {

constexpr int kTranslucentSwaps = 7;

struct Timed {
    double frame_ms = 0.0, pass_ms = 0.0;
};
Timed timed_frame(RadianceRenderer& renderer,
                  const Scene& scene,
                  const EffectLevels& levels,
                  const Progress& progress) {
    FramePlan plan = plan_frame(scene, levels, FrameStage::radiance);
    const auto start = std::chrono::steady_clock::now();
    renderer.render(scene, plan, progress);
    Timed timed;
    timed.frame_ms =
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
    if (const PlannedPass* pass = find_pass(plan, PassKind::subsurface)) {
        timed.pass_ms = pass->ms.value_or(0.0);
    }
    return timed;
}

}  // namespace

TranslucentTimes measure_translucent(RadianceRenderer& renderer,
                                     const Scene& scene,
                                     const EffectLevels& levels,
                                     const Progress& progress) {
    TranslucentTimes times;
    const auto body = static_cast<std::size_t>(part_index(*scene.product, "body"));
    const SurfaceMap& map = renderer.surface_map();
    times.body_fragments = static_cast<double>(map.part_begin[body + 1] - map.part_begin[body]);
    const TranslucentMaterial marble = read_translucent_material("marble");
    const TranslucentMaterial large =
        with_mean_free_path(marble, scene.product->product_scale * mean_free_path_mm(marble));
    const auto count = effect_info(Effect::subsurface).levels.size();
    times.pass_ms.resize(count);
    for (std::size_t level = 1; level < count; ++level) {
        EffectLevels own = levels;
        own[Effect::subsurface] = static_cast<int>(level);
        // What was solved of another level is not this one's
        timed_frame(renderer, scene, own, progress);
        Scene worn = scene;
        std::vector<double> swaps;
        std::vector<double> first;
        for (int k = 0; k <= kTranslucentSwaps; ++k) {
            progress.check_stop();
            TranslucentMaterial medium = large;
            medium.sigma_a_per_mm *= 1.0 + 0.1 * k;
            worn.part_materials[body] = translucent_paint(medium);
            const Timed timed = timed_frame(renderer, worn, own, progress);
            if (k == 0) {
                first.push_back(timed.frame_ms);
                continue;
            }
            swaps.push_back(timed.frame_ms);
            times.pass_ms[level].push_back(timed.pass_ms);
        }
        const std::string name = effect_info(Effect::subsurface).levels[level].name;
        for (auto& [list, ms] :
             {std::pair(&times.first_frames, first), std::pair(&times.swaps, swaps)}) {
            list->push_back(level_of(name, ms));
            list->back().work_items = times.body_fragments;
        }
    }
    return times;
}

}  // namespace livery
