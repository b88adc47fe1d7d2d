// Between which words evaluators may place the looks, once they have voted.
#include <algorithm>
#include <cfloat>
#include <cmath>
#include <optional>
#include <string>

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include "core/error.h"
#include "studio/kit/theme.h"
#include "studio/kit/ui_map.h"
#include "studio/kit/widgets.h"
#include "studio/presenting/presenting.h"

namespace livery {

namespace {

void add_scale(Studio& studio, const SemanticScale& scale) {
    PresentingState& state = presenting(studio);
    PresentingSettings& settings = presenting_settings(studio);
    auto scales = settings.scales;
    scales.push_back(scale);
    try {
        check_scales(scales);
        settings.scales = std::move(scales);
        state.scale_low.clear();
        state.scale_high.clear();
        state.scale_problem.clear();
        keep_presenting_settings(studio);
    } catch (const std::invalid_argument& error) {
        state.scale_problem = error.what();
    }
}

void draw_listed(Studio& studio) {
    PresentingSettings& settings = presenting_settings(studio);
    std::optional<std::size_t> removed;
    for (std::size_t k = 0; k < settings.scales.size(); ++k) {
        ImGui::PushID(static_cast<int>(k));
        if (ImGui::SmallButton("x")) removed = k;
        name_last_item(fmt::format("scales:remove:{}", k));
        tooltip("Not these words.");
        ImGui::SameLine();
        ImGui::TextUnformatted(in_words(settings.scales[k]).c_str());
        name_last_item(fmt::format("scales:pair:{}", k));
        ImGui::PopID();
    }
    if (!removed) return;
    settings.scales.erase(settings.scales.begin() + static_cast<std::ptrdiff_t>(*removed));
    keep_presenting_settings(studio);
}

void draw_new(Studio& studio) {
    PresentingState& state = presenting(studio);
    const float gap = ImGui::GetStyle().ItemInnerSpacing.x, add = button_width("Add");
    const float width = std::floor(0.5f * (ImGui::GetContentRegionAvail().x - add - 2.0f * gap));
    ImGui::SetNextItemWidth(width);
    ImGui::InputTextWithHint("##low", "cheap", &state.scale_low);
    name_last_item("scales:low");
    ImGui::SameLine(0.0f, gap);
    ImGui::SetNextItemWidth(width);
    ImGui::InputTextWithHint("##high", "precious", &state.scale_high);
    name_last_item("scales:high");
    ImGui::SameLine(0.0f, gap);
    if (ImGui::Button("Add")) add_scale(studio, {state.scale_low, state.scale_high});
    name_last_item("scales:add");
    tooltip("Two opposite words, of at most 24 characters each.");
}

void draw_suggestions(Studio& studio) {
    ImGui::SetNextItemWidth(-FLT_MIN);
    const bool open = ImGui::BeginCombo("##suggested", "Suggestions");
    name_last_item("scales:suggestions");
    if (!open) return;
    const auto& listed = presenting_settings(studio).scales;
    const auto& suggested = suggested_scales();
    for (std::size_t k = 0; k < suggested.size(); ++k) {
        if (std::find(listed.begin(), listed.end(), suggested[k]) != listed.end()) continue;
        if (ImGui::Selectable(in_words(suggested[k]).c_str())) {
            add_scale(studio, SemanticScale(suggested[k]));
        }
        name_last_item(fmt::format("scales:suggestion:{}", k));
    }
    ImGui::EndCombo();
}

}  // namespace

void draw_scales_setup(Studio& studio) {
    PresentingSettings& settings = presenting_settings(studio);
    // Beside the other tick, where there is room.
    constexpr const char* label = "Ask on scales";
    place_in_row(button_width(label) + ImGui::GetFrameHeight());
    if (ImGui::Checkbox(label, &settings.asks_scales)) {
        keep_presenting_settings(studio);
    }
    name_last_item("present:scales");
    tooltip(
        "After the ballot a phone asks, look by look, where it lies between two opposite words, in "
        "seven steps. Nobody has to answer.");
    if (!settings.asks_scales) return;
    ImGui::Indent();
    draw_listed(studio);
    if (settings.scales.empty()) dim_text("No words yet: nothing is asked.");
    if (settings.scales.size() < kMostScales) {
        draw_new(studio);
        draw_suggestions(studio);
    }
    const std::string& problem = presenting(studio).scale_problem;
    if (!problem.empty()) {
        warning_text(problem);
        name_last_item("scales:problem");
    }
    ImGui::Unindent();
}

}  // namespace livery
