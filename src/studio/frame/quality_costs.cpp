#include "studio/frame/quality_costs.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include "core/error.h"
#include "core/log.h"
#include "studio/frame/plan_panel.h"
#include "studio/kit/words.h"

namespace livery {

namespace {

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

const PassCosts& pass_costs(Studio& studio) {
    PlanPanelState& state = studio.panels.of<PlanPanelState>();
    if (state.costs) return *state.costs;
    try {
        state.errors = known_effect_errors();
    } catch (const FileError& error) {
        state.problem = error.what();
    }
    try {
        state.costs = known_pass_costs();
    } catch (const FileError& error) {
        state.problem = error.what();
        state.costs = shipped_pass_costs();
    }
    if (state.costs->origin != CostOrigin::measured) state.shipped = shipped_pass_costs();
    return *state.costs;
}

const char* in_words(CostOrigin origin) {
    switch (origin) {
        case CostOrigin::shipped:
            return "by costs from another machine";
        case CostOrigin::scaled:
            return "by costs scaled to what frames took here";
        case CostOrigin::measured:
            return "by the last bench here";
    }
    throw std::invalid_argument("unknown origin of costs");
}

std::optional<PriceList> price_list(Studio& studio) {
    if (!studio.frame || !studio.frame->scene.product) return std::nullopt;
    const std::vector<PassCost>& costs = pass_costs(studio).passes;
    const FinishedFrame& frame = *studio.frame;
    return make_price_list(frame.scene,
                           FrameStage::projector,
                           covered_areas(frame.scene, frame.plan, costs),
                           costs,
                           studio.panels.of<PlanPanelState>().errors);
}

void scale_costs(Studio& studio, const FramePlan& drawn) {
    PlanPanelState& state = studio.panels.of<PlanPanelState>();
    if (pass_costs(studio).origin == CostOrigin::measured) return;
    add_ratios(state.ratios, drawn, state.shipped->passes);
    if (auto scaled = scaled_costs(*state.shipped, state.ratios)) state.costs = std::move(scaled);
}

void keep_scaled_costs(const Studio& studio) {
    const PlanPanelState& state = studio.panels.of<PlanPanelState>();
    if (state.ratios.passes.empty() || state.costs->origin != CostOrigin::scaled) return;
    try {
        // A bench may have run meanwhile; and what cannot be read is not ours to replace
        if (known_pass_costs().origin == CostOrigin::measured) return;
        write_pass_costs(pass_costs_file(), *state.costs);
    } catch (const FileError& error) {
        log_line(LogLevel::warning, error.what());
    }
}

bool remember_costs(MeasuredCosts& measured, const FinishedFrame& frame) {
    // Not by its number: a frame comes again when more of it is there.
    if (frame.done_at == measured.frame_done_at) return false;
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
    if (!measured.newest_was_drawn) return true;
    measured.total_ms = frame.ms_total;
    measured.shade_ms = frame.shade_ms;
    measured.compensate_ms = frame.compensate_ms;
    return true;
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
    PlanPanelState& state = studio.panels.of<PlanPanelState>();
    // Asked of each quality in every frame of the window: priced once a frame of the mock-up.
    if (studio.frame &&
        std::exchange(state.priced_at, studio.frame->done_at) != studio.frame->done_at) {
        const auto list = price_list(studio);
        for (const Quality one : {Quality::draft, Quality::normal, Quality::high}) {
            state.of_qualities.at(static_cast<std::size_t>(one)) =
                list ? quality_cost(*list, one) : std::nullopt;
        }
    }
    const auto cost = quality == Quality::reference
                          ? std::nullopt
                          : state.of_qualities.at(static_cast<std::size_t>(quality));
    if (cost) {
        text += fmt::format(" Predicted {}: {} for new light, then {} a paint.",
                            in_words(pass_costs(studio).origin),
                            milliseconds(cost->solve_ms),
                            milliseconds(cost->frame_ms));
        if (cost->error)
            text += fmt::format(" Off by CIEDE2000 {:.2g} or less on 95% of the product.",
                                *cost->error);
    }
    return text;
}

}  // namespace livery
