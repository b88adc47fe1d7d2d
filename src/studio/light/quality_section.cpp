#include <cmath>

#include <fmt/format.h>
#include <imgui.h>

#include "core/error.h"
#include "studio/drawing.h"
#include "studio/frame/quality_costs.h"
#include "studio/light/lighting_panel.h"
#include "studio/studio.h"

namespace livery {

namespace {

constexpr double kLeast_s = 0.05, kMost_s = 120.0;

void draw_qualities(Studio& studio) {
    const Document& document = studio.session.document();
    const float gap = ImGui::GetStyle().ItemInnerSpacing.x;
    const float width = std::floor((ImGui::GetContentRegionAvail().x - 2.0f * gap) / 3.0f);
    constexpr std::array qualities{Quality::draft, Quality::normal, Quality::high};
    for (const Quality quality : qualities) {
        if (quality != Quality::draft) ImGui::SameLine(0.0f, gap);
        const std::string name = to_string(quality);
        const bool chosen = quality == document.quality && !document.levels;
        if (toggle_button(name.c_str(), chosen, width) && !chosen) {
            commit(studio, SetQuality{quality});
        }
        name_last_item("quality:" + name);
        tooltip(quality_text(studio, quality));
    }
    if (!document.levels) dim_text(quality_text(studio, document.quality));
    if (!refined_levels(document)) return;
    bool refines = refines_while_still(studio.settings);
    if (ImGui::Checkbox("Finer while nothing changes", &refines)) {
        set_refines_while_still(studio.settings, refines);
    }
    name_last_item("refine");
    tooltip(
        "Two seconds after the last change the mock-up's picture is solved at the levels of high, "
        "beside everything else, and fades in. Another paint keeps them; a new light begins with "
        "the levels above.");
}

/// As a quality where one has them.
void choose(Studio& studio, const EffectLevels& levels) {
    const Quality nearest = nearest_quality(levels);
    SetQuality command{nearest, levels};
    if (levels == levels_of(nearest)) command.levels.reset();
    commit(studio, command);
}

void draw_budget(Studio& studio, const PricedFrame& frame) {
    LightingPanelState& state = studio.panels.of<LightingPanelState>();
    if (!(state.budget_s > 0.0)) state.budget_s = 1e-3 * frame.time.all_ms;
    row_label("First frame in");
    ratio_slider("##budget", state.budget_s, kLeast_s, kMost_s, "%.2f s");
    name_last_item("budget");
    tooltip(
        "Chooses the level of each effect for the least visible error in that time. Ctrl+click "
        "types.");
    if (ImGui::IsItemDeactivatedAfterEdit()) {
        state.budget_problem.clear();
        try {
            const auto list = price_list(studio);
            choose(studio, levels_within(*list, {1e3 * state.budget_s, {}}));
        } catch (const Refused& refusal) {
            state.budget_problem = sentence(refusal.what());
        }
    }
    if (!state.budget_problem.empty()) warning_text(state.budget_problem);
    dim_text(
        fmt::format("Predicted {}: {} for new light, then {} a paint; CIEDE2000 {:.2g} or less on "
                    "95% of the product.",
                    in_words(pass_costs(studio).origin),
                    milliseconds(frame.time.all_ms - frame.time.swap_ms),
                    milliseconds(frame.time.swap_ms),
                    frame.error));
}

/// "+120 ms: error -0.4"
std::string change(const PricedFrame& frame, const LevelPrice& other) {
    const double ms = other.time.all_ms - frame.time.all_ms;
    return fmt::format("{}{}, error {:+.2f}",
                       ms < 0.0 ? "-" : "+",
                       milliseconds(std::abs(ms)),
                       other.error - frame.error);
}

std::string text_of(const PricedFrame& frame, const EffectPrice& price) {
    const EffectInfo& info = effect_info(price.effect);
    const auto level = [&](int index) { return info.levels.at(static_cast<std::size_t>(index)); };
    std::string text = sentence(info.in_words) + " " + sentence(level(price.chosen.level).in_words);
    text += fmt::format(" Takes {} here and leaves CIEDE2000 {:.2g} by itself.",
                        milliseconds(price.own_ms),
                        price.added);
    if (price.bound) {
        text += fmt::format(" Bounded by the parts' albedos: at most {:.2g}.", *price.bound);
    }
    if (price.next) {
        text += fmt::format(" {}: {}.", level(price.next->level).name, change(frame, *price.next));
    }
    if (price.off) {
        text += fmt::format(" {}: {}.", level(price.off->level).name, change(frame, *price.off));
    }
    return text;
}

void draw_effect(Studio& studio, const PricedFrame& frame, const EffectPrice& price) {
    const EffectInfo& info = effect_info(price.effect);
    const std::string label = sentence(info.name);
    row_label(label.substr(0, label.size() - 1).c_str());
    begin_disabled(!price.called_for);
    const auto chosen = static_cast<std::size_t>(frame.levels[price.effect]);
    const std::string shown = price.called_for ? fmt::format("{}  ({}, {:.2g})",
                                                             info.levels[chosen].name,
                                                             milliseconds(price.own_ms),
                                                             price.added)
                                               : "not called for";
    const bool open = ImGui::BeginCombo(fmt::format("##{}", info.name).c_str(), shown.c_str());
    name_last_item(fmt::format("effect:{}", info.name));
    if (!open) {
        tooltip(price.called_for ? text_of(frame, price)
                                 : sentence(info.in_words) + " This look does not call for it.");
        end_disabled();
        return;
    }
    for (std::size_t k = 0; k < info.levels.size(); ++k) {
        if (ImGui::Selectable(info.levels[k].name, k == chosen) && k != chosen) {
            EffectLevels levels = frame.levels;
            levels[price.effect] = static_cast<int>(k);
            choose(studio, levels);
        }
        name_last_item(fmt::format("effect:{}:{}", info.name, info.levels[k].name));
        tooltip(sentence(info.levels[k].in_words));
    }
    ImGui::EndCombo();
    end_disabled();
}

/// Of the levels in the document, for the frame on the mock-up; kept until either changes.
const PricedFrame* priced_frame(Studio& studio) {
    PlanPanelState& state = studio.panels.of<PlanPanelState>();
    const Document& document = studio.session.document();
    if (!studio.frame || (document.quality == Quality::reference && !document.levels)) {
        return nullptr;
    }
    const EffectLevels levels = document.levels ? *document.levels : levels_of(document.quality);
    const bool stands = state.frame_priced_at == studio.frame->done_at && state.frame_price &&
                        state.frame_price->levels == levels;
    if (!stands) {
        const auto list = price_list(studio);
        state.frame_price = list ? std::optional(priced(*list, levels)) : std::nullopt;
        state.frame_priced_at = studio.frame->done_at;
    }
    return state.frame_price ? &*state.frame_price : nullptr;
}

}  // namespace

void draw_quality_section(Studio& studio) {
    heading("Quality");
    draw_qualities(studio);
    draw_reference_row(studio);
    const PricedFrame* frame = priced_frame(studio);
    if (!frame) return;
    draw_budget(studio, *frame);
    if (button("What accuracy costs…", "accuracy")) show_panel(studio, "accuracy");
    const bool open = section_header("Effects, their price and what they leave###effects");
    name_last_item("effects");
    if (!open) return;
    // A choice in the loop prices the frame anew
    const PricedFrame shown = *frame;
    for (const EffectPrice& price : shown.effects) draw_effect(studio, shown, price);
}

}  // namespace livery
