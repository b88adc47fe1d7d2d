#include "studio/frame/quality_costs.h"

#include <algorithm>
#include <stdexcept>

#include <fmt/format.h>
#include <imgui.h>

#include "core/error.h"
#include "core/log.h"

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

namespace {

enum class CostKind { every_frame, solved_once, prepared };

CostKind kind_of(const PlannedPass& pass) {
    if (pass.id.kind == PassKind::prepare) return CostKind::prepared;
    return runs_every_frame(pass.id) ? CostKind::every_frame : CostKind::solved_once;
}

void right_aligned(const std::string& text, const ImVec4& colour) {
    const float width = ImGui::CalcTextSize(text.c_str()).x;
    ImGui::SameLine();
    ImGui::SetCursorPosX(
        std::max(ImGui::GetCursorPosX(), ImGui::GetWindowContentRegionMax().x - width));
    ImGui::TextColored(colour, "%s", text.c_str());
}

void draw_totals(const Studio& studio, const FinishedFrame& frame, const PassCosts& costs) {
    const MeasuredCosts& measured = studio.panels.of<PlanPanelState>().measured;
    double predicted = 0.0;
    bool complete = true;
    for (const PlannedPass& pass : frame.plan.passes) {
        if (kind_of(pass) != CostKind::every_frame) continue;
        complete = complete && pass.predicted_ms.has_value();
        predicted += pass.predicted_ms.value_or(0.0);
    }
    ImGui::PushFont(large_font());
    ImGui::TextUnformatted(milliseconds(measured.total_ms).c_str());
    ImGui::PopFont();
    name_last_item("frame-total");
    tooltip(
        "From the frame's description to its finished projector picture: the sum of what stands "
        "below under With every paint.");
    dim_text(fmt::format("Quality {}. Shading {}, correction {}.",
                         to_string(frame.plan.quality),
                         milliseconds(measured.shade_ms),
                         milliseconds(measured.compensate_ms)));
    if (!measured.newest_was_drawn) {
        dim_text("The newest picture was there already: these are the last measured.");
    }
    dim_text(complete
                 ? fmt::format("Predicted {}: {}.", in_words(costs.origin), milliseconds(predicted))
                 : "Not predicted: nobody has timed every pass of this frame.");
    if (!studio.panels.of<PlanPanelState>().problem.empty())
        warning_text(studio.panels.of<PlanPanelState>().problem);
    if (!frame.unfinished.empty()) warning_text(sentence("not final yet: " + frame.unfinished));
    if (!frame.problem.empty()) warning_text(sentence("not drawn: " + frame.problem));
}

void draw_reach(const FinishedFrame& frame) {
    const CompensationStats& stats = frame.compensation;
    heading("What the projector cannot show");
    const auto row = [](const char* label, double fraction, const char* meaning) {
        ImGui::TextUnformatted(label);
        right_aligned(fmt::format("{:.2f} %", 100.0 * fraction),
                      fraction > 0.01 ? colours::warning : colours::text);
        tooltip(meaning);
    };
    row("Out of reach",
        stats.out_of_gamut_fraction,
        "Pixels that show another colour than wanted.");
    row("  too bright", stats.clipped_high_fraction, "Lower the exposure, or the design white.");
    row("  too dark",
        stats.clipped_low_fraction,
        "Darker than the projector's black and the room.");
    row("Left black", stats.invalid_fraction, "Pixels without a correction, or not finite.");
}

void draw_pass(const std::string& name, const PlannedPass& pass, double longest_ms) {
    ImGui::PushID(name.c_str());
    ImGui::TextUnformatted(name.c_str());
    name_last_item("pass:" + name);
    tooltip(pass.predicted_ms ? fmt::format("Predicted {}.", milliseconds(*pass.predicted_ms))
                              : "Not predicted: " + pass.unpredicted_because + ".");
    right_aligned(pass.ms ? milliseconds(*pass.ms) : "–", colours::text);
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float width = ImGui::GetContentRegionAvail().x, height = std::max(2.0f, em(0.16f));
    const float top = at.y - 0.5f * ImGui::GetStyle().ItemSpacing.y;
    ImDrawList* draw = ImGui::GetWindowDrawList();
    draw->AddRectFilled(
        {at.x, top}, {at.x + width, top + height}, ImGui::GetColorU32(colours::raised));
    if (pass.ms && longest_ms > 0.0) {
        const auto share = static_cast<float>(std::clamp(*pass.ms / longest_ms, 0.0, 1.0));
        draw->AddRectFilled({at.x, top},
                            {at.x + share * width, top + height},
                            ImGui::GetColorU32(ImGuiCol_PlotHistogram));
    }
    ImGui::PushFont(small_font());
    dim_text(pass.why);
    ImGui::PopFont();
    ImGui::PopID();
}

/// `beside_ms`: what goes with them and is none of them; none: they are the whole.
void draw_passes(const FramePlan& plan,
                 CostKind kind,
                 const char* title,
                 std::optional<double> beside_ms = std::nullopt) {
    double longest_ms = beside_ms.value_or(0.0);
    bool any = false;
    for (const PlannedPass& pass : plan.passes) {
        if (kind_of(pass) != kind) continue;
        any = true;
        longest_ms = std::max(longest_ms, pass.ms.value_or(0.0));
    }
    if (!any) return;
    ImGui::Spacing();
    heading(title);
    for (const PlannedPass& pass : plan.passes) {
        if (kind_of(pass) == kind) draw_pass(to_string(pass.id), pass, longest_ms);
    }
    if (!beside_ms) return;
    PlannedPass rest;
    rest.why = "handing the picture from one to the next and to the projector";
    rest.ms = *beside_ms;
    rest.unpredicted_because = "it is no pass";
    draw_pass("between the passes", rest, longest_ms);
}

void draw_skipped(const FramePlan& plan) {
    ImGui::Spacing();
    const auto count = std::count_if(plan.skipped.begin(),
                                     plan.skipped.end(),
                                     [](const auto& pass) { return !is_of_other_paints(pass); });
    const std::string title = fmt::format("Not run ({})###skipped", count);
    const bool open = named(section_header(title.c_str()), "skipped-passes");
    if (!open) return;
    for (const SkippedPass& pass : plan.skipped) {
        if (is_of_other_paints(pass)) continue;
        const std::string name = to_string(pass.id);
        ImGui::TextUnformatted(name.c_str());
        name_last_item("skipped:" + name);
        ImGui::PushFont(small_font());
        dim_text(pass.why);
        ImGui::PopFont();
    }
}

}  // namespace

void draw_plan_panel(Studio& studio) {
    if (!studio.frame) {
        dim_text("No frame has been drawn yet.");
        return;
    }
    FinishedFrame frame = *studio.frame;
    show_last_measured(studio.panels.of<PlanPanelState>().measured, frame.plan);
    const PassCosts& costs = pass_costs(studio);
    predict_times(frame.plan, costs.passes);
    if (frame.scene.product) say_why(frame.scene, frame.plan);
    if (frame.wiped_to) say_why(*frame.wiped_to, frame.plan);
    draw_totals(studio, frame, costs);
    draw_passes(frame.plan,
                CostKind::every_frame,
                "With every paint",
                time_beside_passes_ms(studio.panels.of<PlanPanelState>().measured, frame.plan));
    draw_passes(frame.plan, CostKind::solved_once, "Once for light, eye and pose");
    draw_passes(frame.plan, CostKind::prepared, "Prepared while idle");
    draw_skipped(frame.plan);
    ImGui::Spacing();
    if (studio.setup && studio.setup->table) {
        draw_reach(frame);
    } else {
        dim_text("The picture goes out uncorrected: what the projector cannot show is not known.");
    }
}

Panel plan_panel() {
    return {.name = "Frame",
            .place = PanelPlace::tab,
            .draw = draw_plan_panel,
            .step =
                [](Studio& s) {
                    MeasuredCosts& measured = s.panels.of<PlanPanelState>().measured;
                    if (s.frame && remember_costs(measured, *s.frame))
                        scale_costs(s, s.frame->plan);
                },
            .stop = [](Studio& s) { keep_scaled_costs(s); }};
}

}  // namespace livery
