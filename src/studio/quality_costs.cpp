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

/// Timed by the bench in the place of a look's own paint, not beside it.
bool is_of_another_paint(const PassId& pass) {
    const bool shades = pass.kind == PassKind::shade && pass.model == ReflectanceModel::car_paint;
    return shades || pass == PassKind::glint_places;
}

}  // namespace

bool runs_every_frame(const PassId& pass) {
    return pass.kind == PassKind::shade || pass == PassKind::diffuse_light ||
           pass == PassKind::resolve || pass == PassKind::compensation;
}

std::optional<QualityCost> quality_cost(const std::vector<PassCost>& costs,
                                        Quality quality,
                                        double pixels) {
    const auto resolve = std::find_if(costs.begin(), costs.end(), [&](const PassCost& cost) {
        return cost.quality == quality && cost.pass == PassKind::resolve;
    });
    if (resolve == costs.end() || !(resolve->work_items > 0.0) || !(pixels > 0.0)) {
        return std::nullopt;
    }
    QualityCost sum;
    sum.error = resolve->error;
    for (const PassCost& cost : costs) {
        // Of looks that have artwork or a relief: theirs to add.
        const bool artwork = cost.pass == PassKind::artwork || cost.pass == PassKind::relief;
        if (cost.quality != quality || artwork || is_of_another_paint(cost.pass)) continue;
        const double ms = cost.work_items > 0.0 ? cost.ms * pixels / resolve->work_items : cost.ms;
        (runs_every_frame(cost.pass) ? sum.frame_ms : sum.solve_ms) += ms;
    }
    return sum;
}

const std::vector<PassCost>* bench_costs(Studio& studio) {
    PlanPanelState& state = *studio.panels.plan;
    if (!std::exchange(state.costs_read, true)) {
        try {
            state.costs = read_pass_costs(ledger_file());
        } catch (const FileError& error) {
            state.problem = error.what();
        }
    }
    return state.costs ? &*state.costs : nullptr;
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
    const std::vector<PassCost>* costs = bench_costs(studio);
    const PlannedPass* resolve =
        studio.frame ? find_pass(studio.frame->plan, PassKind::resolve) : nullptr;
    const auto cost =
        costs && resolve ? quality_cost(*costs, quality, resolve->work_items) : std::nullopt;
    if (cost) {
        text += fmt::format(" By the last bench here: {} for new light, then {} a paint.",
                            milliseconds(cost->solve_ms),
                            milliseconds(cost->frame_ms));
        if (cost->error)
            text +=
                fmt::format(" Off by CIEDE2000 {:.2g} or less on 95% of the car.", *cost->error);
    } else if (!costs) {
        text += " What it costs here is not known: run livery bench --suite speed.";
    }
    return text;
}

}  // namespace livery
