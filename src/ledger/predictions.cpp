#include "ledger/predictions.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "core/worst_error.h"
#include "radiance/renderer.h"
#include "radiance/surface_map.h"
#include "tracing/tracer.h"

namespace livery {

namespace {

/// The mock-up is counted on a picture this many times smaller a side.
constexpr int kCoarse = 4;

std::optional<double> fragments_per_pixel(const std::vector<PassCost>& costs,
                                          const EffectLevels& levels) {
    const PassCost* map = find_cost(costs, PassKind::surface_map, levels);
    return map ? map->fragments_per_pixel : std::nullopt;
}

}  // namespace

FrameCounts covered_areas(const Scene& scene, const View& view, const Progress& progress) {
    const View coarse =
        resized(view, std::max(1, view.width / kCoarse), std::max(1, view.height / kCoarse));
    const glm::dvec2 scale =
        glm::dvec2(coarse.width, coarse.height) / glm::dvec2(view.width, view.height);
    const Mesh& mesh = scene.product->mesh;
    const SurfaceMap map = build_surface_map(mesh, Tracer(mesh), coarse, 16, progress);
    // Fragments of many small parts would be counted several times a coarse pixel: area counts.
    FrameCounts counts;
    counts.fragments_of_part.resize(mesh.parts.size());
    counts.fragments_of_artwork.resize(scene.artwork.size());
    for (std::size_t i = 0; i < map.fragments.size(); ++i) {
        const Fragment& fragment = map.fragments[i];
        const double pixels = static_cast<double>(fragment.coverage) / (scale.x * scale.y);
        counts.fragments_of_part[fragment.part] += pixels;
        counts.covered_pixels += pixels;
        for (std::size_t k = 0; k < scene.artwork.size(); ++k) {
            const PartArtwork& artwork = scene.artwork[k];
            if (artwork.part != fragment.part) continue;
            const SurfaceSample& sample = map.samples[i * kSamplesAFragment];
            const SurfacePoint point =
                surface_point(mesh, Hit{sample.triangle, 0.0f, sample.barycentric});
            const ArtworkPoint at = artwork_at(artwork,
                                               glm::dvec3(fragment.position_mm),
                                               glm::dvec3(fragment.normal),
                                               glm::dvec2(point.uv));
            if (at.cover > 0.0) counts.fragments_of_artwork[k] += pixels;
        }
    }
    return counts;
}

FrameCounts covered_areas(const Scene& scene,
                          const FramePlan& drawn,
                          const std::vector<PassCost>& costs) {
    const Scene as_drawn = at_levels(scene, drawn.levels);
    FrameCounts areas;
    if (const PlannedPass* resolve = find_pass(drawn, PassKind::resolve)) {
        areas.covered_pixels = resolve->work_items;
    }
    const double per_pixel = fragments_per_pixel(costs, drawn.levels).value_or(1.0);
    const auto items = [&](const PassId& id, double each) {
        const PlannedPass* pass = find_pass(drawn, id);
        return pass ? pass->work_items / (per_pixel * each) : 0.0;
    };
    for (std::size_t p = 0; p < as_drawn.part_materials.size(); ++p) {
        areas.fragments_of_part.push_back(items(shade_pass(as_drawn, p), 1.0));
    }
    for (std::size_t k = 0; k < as_drawn.artwork.size(); ++k) {
        const auto coats = static_cast<double>(coats_of(as_drawn.artwork[k]).size());
        areas.fragments_of_artwork.push_back(items(artwork_pass(as_drawn, k), coats));
    }
    return areas;
}

FrameCounts counts_at(FrameCounts areas,
                      const EffectLevels& levels,
                      const std::vector<PassCost>& costs) {
    areas.samples_per_pixel = sub_samples_of(levels);
    const double per_pixel = fragments_per_pixel(costs, levels).value_or(1.0);
    for (double& fragments : areas.fragments_of_part) fragments *= per_pixel;
    for (double& fragments : areas.fragments_of_artwork) fragments *= per_pixel;
    return areas;
}

std::string predict_times(FramePlan& plan, const std::vector<PassCost>& costs) {
    std::string note;
    for (PlannedPass& pass : plan.passes) {
        const PassCost* cost = find_cost(costs, pass.id, plan.levels);
        if (!cost) {
            const auto effect = effect_of(pass.id);
            pass.unpredicted_because =
                fmt::format("nobody has timed {}", to_string(cost_key(pass.id)));
            if (effect) {
                const EffectInfo& info = effect_info(*effect);
                const auto level = static_cast<std::size_t>(plan.levels[*effect]);
                pass.unpredicted_because +=
                    fmt::format(" at {}={}", info.name, info.levels[level].name);
            }
            note = "some passes are not predicted: see unpredicted_because";
            continue;
        }
        pass.predicted_ms = predicted_ms(*cost, pass.work_items);
    }
    return note;
}

void predict_errors(FramePlan& plan,
                    const std::array<bool, kEffects>& called_for,
                    const EffectErrors& errors) {
    std::array<bool, kEffects> told{};
    for (PlannedPass& pass : plan.passes) {
        const auto effect = effect_of(pass.id);
        if (pass.id == PassKind::resolve) {
            pass.predicted_error = error_of(errors, plan.levels, called_for);
        } else if (effect && !std::exchange(told[static_cast<std::size_t>(*effect)], true)) {
            double worst = 0.0;
            for (const SceneErrors& one : errors) {
                worst = worse_of(worst, error_added(one, *effect, plan.levels[*effect]));
            }
            pass.predicted_error = std::sqrt(worst);
        }
        if (!pass.predicted_error && pass.unpredicted_because.empty()) {
            pass.unpredicted_because = "its part of the error stands at another pass";
        }
    }
}

PredictedTime predicted_time(const FramePlan& plan) {
    PredictedTime time;
    for (const PlannedPass& pass : plan.passes) {
        time.complete = time.complete && pass.predicted_ms.has_value();
        const double ms = pass.predicted_ms.value_or(0.0);
        time.all_ms += ms;
        if (runs_every_frame(pass.id)) time.swap_ms += ms;
    }
    return time;
}

}  // namespace livery
