#include "studio/quality_costs.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include "core/error.h"
#include "studio/kit/words.h"
#include "studio/plan_panel.h"

namespace livery {

namespace {

/// Passes that find everything done before still take some microseconds.
constexpr double kNothingToDo_ms = 0.05;

const char* what_it_does(Quality quality) {
    switch (quality) {
        case Quality::draft:
            return "Sharp shadows; the environment reaches every point.";
        case Quality::normal:
            return "Soft shadows; parts hide the environment from one another.";
        case Quality::high:
            return "As normal, with more samples of shadows and mirrored light; parts light one "
                   "another.";
        case Quality::reference:
            return "The ground truth, path traced.";
    }
    throw std::invalid_argument("unknown quality");
}

}  // namespace

std::optional<QualityCost> quality_cost(const PriceList& list, Quality quality) {
    const PredictedTime time = time_of(list, levels_of(quality));
    if (!time.complete) return std::nullopt;
    return QualityCost{
        time.all_ms - time.swap_ms, time.swap_ms, error_of(list, levels_of(quality))};
}

const std::vector<PassCost>* bench_costs(Studio& studio) {
    PlanPanelState& state = *studio.panels.plan;
    if (!std::exchange(state.costs_read, true)) {
        try {
            state.costs = read_pass_costs(pass_costs_file());
            state.errors = known_effect_errors();
        } catch (const FileError& error) {
            state.problem = error.what();
        }
    }
    return state.costs ? &*state.costs : nullptr;
}

std::optional<PriceList> price_list(Studio& studio) {
    const std::vector<PassCost>* costs = bench_costs(studio);
    if (!costs || !studio.frame || !studio.frame->scene.product) return std::nullopt;
    const FinishedFrame& frame = *studio.frame;
    return make_price_list(frame.scene,
                           FrameStage::projector,
                           covered_areas(frame.scene, frame.plan, *costs),
                           *costs,
                           studio.panels.plan->errors);
}

void remember_costs(MeasuredCosts& measured, const FinishedFrame& frame) {
    // Not by its number: a frame comes again when more of it is there.
    if (frame.done_at == measured.frame_done_at) return;
    measured.frame_done_at = frame.done_at;
    const auto did_something = [](const PlannedPass& pass) {
        return pass.ms.value_or(0.0) >= kNothingToDo_ms;
    };
    measured.newest_was_drawn =
        std::any_of(frame.plan.passes.begin(), frame.plan.passes.end(), [&](const auto& pass) {
            return did_something(pass) && runs_every_frame(pass.id);
        });
    if (measured.newest_was_drawn) {
        // Those of one frame, so that they add up to it.
        std::erase_if(measured.pass_ms,
                      [](const auto& known) { return runs_every_frame(known.first.second); });
    }
    for (const PlannedPass& pass : frame.plan.passes) {
        const bool of_this_frame = measured.newest_was_drawn && runs_every_frame(pass.id);
        if (!did_something(pass) && !(of_this_frame && pass.ms)) continue;
        measured.pass_ms[{frame.plan.quality, pass.id}] = *pass.ms;
    }
    if (!measured.newest_was_drawn) return;
    measured.total_ms = frame.ms_total;
    measured.shade_ms = frame.shade_ms;
    measured.compensate_ms = frame.compensate_ms;
}

void show_last_measured(const MeasuredCosts& measured, FramePlan& plan) {
    for (PlannedPass& pass : plan.passes) {
        const auto last = measured.pass_ms.find({plan.quality, pass.id});
        pass.ms.reset();
        if (last != measured.pass_ms.end()) pass.ms = last->second;
    }
}

double time_beside_passes_ms(const MeasuredCosts& measured, const FramePlan& plan) {
    double passes_ms = 0.0;
    for (const PlannedPass& pass : plan.passes) {
        if (runs_every_frame(pass.id)) passes_ms += pass.ms.value_or(0.0);
    }
    return std::max(0.0, measured.total_ms - passes_ms);
}

std::string quality_text(Studio& studio, Quality quality) {
    std::string text = what_it_does(quality);
    PlanPanelState& state = *studio.panels.plan;
    // Asked of each quality in every frame of the window: priced once a frame of the mock-up.
    if (studio.frame &&
        std::exchange(state.priced_at, studio.frame->done_at) != studio.frame->done_at) {
        const auto list = price_list(studio);
        for (const Quality one : {Quality::draft, Quality::normal, Quality::high}) {
            state.of_qualities.at(static_cast<std::size_t>(one)) =
                list ? quality_cost(*list, one) : std::nullopt;
        }
    }
    const std::vector<PassCost>* costs = bench_costs(studio);
    const auto cost = quality == Quality::reference
                          ? std::nullopt
                          : state.of_qualities.at(static_cast<std::size_t>(quality));
    if (cost) {
        text += fmt::format(" By the last bench here: {} for new light, then {} a paint.",
                            milliseconds(cost->solve_ms),
                            milliseconds(cost->frame_ms));
        if (cost->error)
            text += fmt::format(" Off by CIEDE2000 {:.2g} or less on 95% of the product.",
                                *cost->error);
    } else if (!costs) {
        text += " What it costs here is not known: run livery bench --suite speed.";
    }
    return text;
}

}  // namespace livery
