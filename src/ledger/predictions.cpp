#include "ledger/predictions.h"

#include <algorithm>
#include <map>
#include <vector>

#include <fmt/format.h>

#include "core/error.h"
#include "radiance/surface_map.h"
#include "tracing/tracer.h"

namespace livery {

namespace {

/// The mock-up is counted on a picture this many times smaller a side.
constexpr int kCoarse = 4;

struct FragmentCounts {
    std::map<std::string, double> by_part;
    std::vector<double> of_artwork;  ///< that it covers, as often as it is shaded
    double wearing = 0.0, tilted = 0.0, all = 0.0;
};

FragmentCounts count_fragments(const Scene& scene, const View& view, const Progress& progress) {
    const View coarse =
        resized(view, std::max(1, view.width / kCoarse), std::max(1, view.height / kCoarse));
    const glm::dvec2 scale =
        glm::dvec2(coarse.width, coarse.height) / glm::dvec2(view.width, view.height);
    const Mesh& mesh = scene.product->mesh;
    const SurfaceMap map = build_surface_map(mesh, Tracer(mesh), coarse, 16, progress);
    // Fragments of many small parts would be counted several times a coarse pixel: area counts.
    FragmentCounts counts;
    counts.of_artwork.resize(scene.artwork.size());
    for (std::size_t i = 0; i < map.fragments.size(); ++i) {
        const Fragment& fragment = map.fragments[i];
        const double pixels = static_cast<double>(fragment.coverage) / (scale.x * scale.y);
        counts.by_part[mesh.parts[fragment.part].name] += pixels;
        counts.all += pixels;
        if (relief_of(scene, fragment.part)) counts.tilted += pixels;
        for (std::size_t k = 0; k < scene.artwork.size(); ++k) {
            const PartArtwork& artwork = scene.artwork[k];
            if (artwork.part != fragment.part) continue;
            counts.wearing += pixels;
            const SurfaceSample& sample = map.samples[i * kSamplesAFragment];
            const SurfacePoint point =
                surface_point(mesh, Hit{sample.triangle, 0.0f, sample.barycentric});
            const ArtworkPoint at = artwork_at(artwork,
                                               glm::dvec3(fragment.position_mm),
                                               glm::dvec3(fragment.normal),
                                               glm::dvec2(point.uv));
            if (at.cover > 0.0) counts.of_artwork[k] += pixels;
        }
    }
    for (std::size_t k = 0; k < scene.artwork.size(); ++k) {
        counts.of_artwork[k] *= static_cast<double>(coats_of(scene.artwork[k]).size());
    }
    return counts;
}

double items_of(const PassId& pass, const FragmentCounts& counts) {
    if (pass == PassKind::artwork) return counts.wearing;
    if (pass == PassKind::relief) return counts.tilted;
    if (pass.kind != PassKind::shade) return counts.all;
    if (pass.artwork) return counts.of_artwork[*pass.artwork];
    const auto part = counts.by_part.find(pass.part);
    return part == counts.by_part.end() ? 0.0 : part->second;
}

}  // namespace

std::optional<std::vector<PassCost>> known_pass_costs() {
    std::filesystem::path file;
    try {
        file = ledger_file();
    } catch (const FileError&) {
        return std::nullopt;
    }
    return read_pass_costs(file);
}

PassId cost_key(const PassId& pass) { return {pass.kind, "", pass.model, pass.glints}; }

std::string predict(FramePlan& plan,
                    const Scene& scene,
                    const View& view,
                    const Progress& progress) {
    const auto costs = known_pass_costs();
    if (!costs) {
        for (PlannedPass& pass : plan.passes) {
            pass.unpredicted_because = "no bench has run on this machine";
        }
        return "no predictions: no bench has run on this machine (livery bench --suite speed)";
    }
    const FragmentCounts counts = count_fragments(scene, view, progress);
    for (PlannedPass& pass : plan.passes) pass.work_items = items_of(pass.id, counts);
    return predict_drawn(plan, *costs);
}

std::string predict_drawn(FramePlan& plan, const std::vector<PassCost>& costs) {
    if (plan.quality != Quality::reference && plan.levels != levels_of(plan.quality)) {
        for (PlannedPass& pass : plan.passes) {
            pass.unpredicted_because =
                "the bench times the levels of qualities, and these are others";
        }
        return "no predictions: the bench times the levels of qualities, and these are others";
    }
    // The bench times shading per fragment and all else per pixel of the mock-up.
    const PlannedPass* resolve = find_pass(plan, PassKind::resolve);
    const double pixels = resolve ? resolve->work_items : 0.0;
    std::string note;
    for (PlannedPass& pass : plan.passes) {
        const auto known = std::find_if(costs.begin(), costs.end(), [&](const PassCost& cost) {
            return cost.pass == cost_key(pass.id) && cost.quality == plan.quality;
        });
        if (known == costs.end()) {
            pass.unpredicted_because = fmt::format("the last bench did not time {} at {} quality",
                                                   to_string(pass.id),
                                                   to_string(plan.quality));
            note = "some passes are not predicted: see unpredicted_because";
            continue;
        }
        const bool counted = pass.id.kind == PassKind::shade || pass.id == PassKind::artwork ||
                             pass.id == PassKind::relief;
        const double items = counted ? pass.work_items : pixels;
        pass.predicted_ms =
            known->work_items > 0.0 ? known->ms * items / known->work_items : known->ms;
        pass.predicted_error = known->error;
        if (!known->error) {
            pass.unpredicted_because =
                "its part of the error is not measured apart: the frame's stands at " +
                to_string(PassKind::resolve);
        }
    }
    return note;
}

BudgetChoice quality_within(const Scene& scene,
                            const View& view,
                            FrameStage stage,
                            double budget_ms) {
    if (!known_pass_costs()) {
        throw Refused("--budget-ms: no bench has run on this machine, so no cost is known",
                      "run livery bench --suite speed, or choose --quality");
    }
    double cheapest = 0.0;
    for (const Quality quality : {Quality::high, Quality::normal, Quality::draft}) {
        FramePlan plan = plan_frame(scene, quality, stage);
        predict(plan, scene, view);
        double total = 0.0;
        bool complete = true;
        for (const PlannedPass& pass : plan.passes) {
            complete = complete && pass.predicted_ms.has_value();
            total += pass.predicted_ms.value_or(0.0);
        }
        cheapest = total;
        if (complete && total <= budget_ms) {
            return {quality,
                    fmt::format("{} quality: {:.1f} ms predicted, {:.1f} ms allowed\n",
                                to_string(quality),
                                total,
                                budget_ms)};
        }
    }
    throw Refused(
        fmt::format("--budget-ms: no quality fits {:.1f} ms; draft is predicted to take {:.1f} ms",
                    budget_ms,
                    cheapest),
        "allow more time, or lower the resolution");
}

}  // namespace livery
