#include "studio/light/accuracy_page.h"

#include <algorithm>
#include <set>
#include <utility>

#include <fmt/format.h>
#include <imgui.h>

#include "core/error.h"
#include "scene/effects.h"
#include "studio/kit/background.h"
#include "studio/kit/theme.h"
#include "studio/kit/ui_map.h"
#include "studio/kit/widgets.h"
#include "studio/kit/words.h"
#include "studio/light/accuracy_chart.h"
#include "studio/light/lighting_panel.h"
#include "studio/presenting/presenting.h"
#include "studio/studio.h"

namespace livery {

namespace {

AccuracyPage& page_of(const Studio& studio) { return studio.panels.lighting->accuracy; }

void show(AccuracyPage& page, std::shared_ptr<const AccuracyLedger> ledger, bool measured_here) {
    page.shown = std::move(ledger);
    page.measured_here = measured_here;
    page.levels = levels_of(*page.shown);
    page.on_front = front_of(page.levels);
    page.pointed = -1;
}

void read_known(AccuracyPage& page) {
    try {
        KnownAccuracy known = known_accuracy();
        show(page,
             std::make_shared<const AccuracyLedger>(std::move(known.ledger)),
             known.measured_here);
    } catch (const FileError& error) {
        page.problem = error.what();
    }
}

std::string measured_on(const AccuracyPage& page, bool running) {
    std::set<std::string> scenes;
    for (const AccuracyRow& row : page.shown->rows) scenes.insert(row.scene);
    return fmt::format("{} {}, {} threads, 640x400, {} {}, against {} paths a pixel.{}",
                       running              ? "So far, on this machine:"
                       : page.measured_here ? "Measured on this machine:"
                                            : "Shipped with the program, measured elsewhere:",
                       page.shown->renderer,
                       page.shown->threads,
                       scenes.size(),
                       scenes.size() == 1 ? "scene" : "scenes",
                       2 * page.shown->samples_per_pixel,
                       running || page.measured_here ? "" : " Errors hold here too, times do not.");
}

void draw_measuring(Studio& studio, const AccuracyThread::State& now) {
    AccuracyPage& page = page_of(studio);
    if (now.running) {
        if (ImGui::Button("Stop")) page.thread->stop();
        name_last_item("accuracy:stop");
        ImGui::SameLine();
        progress_bar(now.fraction, now.doing);
        return;
    }
    const bool presenting = is_presenting(studio);
    begin_disabled(presenting);
    if (ImGui::Button("Measure on this machine")) {
        if (!page.thread) page.thread = std::make_unique<AccuracyThread>(wake_main_thread);
        page.problem.clear();
        page.thread->measure();
    }
    name_last_item("accuracy:measure");
    end_disabled();
    tooltip(presenting
                ? "A vote is presented."
                : "The shipped car in red in the studio, some minutes on a few cores: traced "
                  "first, then drawn at each level. Leave the program alone meanwhile, or "
                  "times are of both. What was traced is kept.");
    ImGui::SameLine();
    dim_text("All looks and lights: livery bench --suite accuracy");
}

/// Whether the mock-up is drawn at this level now.
bool is_drawn_at(const Studio& studio, const AccuracyLevel& level) {
    if (!studio.frame || studio.frame->plan.quality == Quality::reference) return false;
    const EffectLevels& levels = studio.frame->plan.levels;
    if (level.effect == kQualityRows) return levels == levels_of(parse_quality(level.level));
    for (const EffectInfo& info : effect_table()) {
        if (info.name == level.effect) {
            return levels[info.effect] == level.index &&
                   calls_for(studio.frame->scene, info.effect);
        }
    }
    return false;
}

void cell(const ImVec4& colour, const std::string& text) {
    ImGui::TableNextColumn();
    ImGui::TextColored(colour, "%s", text.c_str());
}

void draw_table(Studio& studio, int pointed_in_chart) {
    AccuracyPage& page = page_of(studio);
    constexpr ImGuiTableFlags kFlags = ImGuiTableFlags_SizingStretchProp | ImGuiTableFlags_ScrollY |
                                       ImGuiTableFlags_RowBg | ImGuiTableFlags_PadOuterX;
    if (!ImGui::BeginTable("levels", 7, kFlags, ImGui::GetContentRegionAvail())) return;
    ImGui::TableSetupScrollFreeze(0, 1);
    for (const char* name :
         {"Effect", "Level", "New light", "Paint swap", "Median", "95%", "99%"}) {
        ImGui::TableSetupColumn(name);
    }
    ImGui::TableHeadersRow();
    int pointed = pointed_in_chart;
    for (std::size_t k = 0; k < page.levels.size(); ++k) {
        const AccuracyLevel& level = page.levels[k];
        const bool drawn = is_drawn_at(studio, level);
        const ImVec4& colour = drawn ? colours::good : colours::text;
        ImGui::TableNextRow();
        ImGui::TableNextColumn();
        const bool first = k == 0 || page.levels[k - 1].effect != level.effect;
        const std::string id = fmt::format("{}##{}", first ? level.effect : "", k);
        ImGui::PushStyleColor(ImGuiCol_Text, colours::dim_text);
        ImGui::Selectable(
            id.c_str(), static_cast<int>(k) == page.pointed, ImGuiSelectableFlags_SpanAllColumns);
        ImGui::PopStyleColor();
        name_last_item(fmt::format("accuracy:{}:{}", level.effect, level.level));
        if (ImGui::IsItemHovered()) pointed = static_cast<int>(k);
        if (drawn) tooltip("The mock-up is drawn at this level now.");
        cell(colour, level.level);
        cell(colour, milliseconds(level.solve_ms));
        cell(colour, milliseconds(level.swap_ms));
        cell(level.resolved ? colour : colours::dim_text, fmt::format("{:.2f}", level.median));
        if (!level.resolved) tooltip("Less than what the truth itself may err by.");
        cell(colour, fmt::format("{:.2f}", level.p95));
        cell(colour, fmt::format("{:.2f}", level.p99));
    }
    ImGui::EndTable();
    page.pointed = pointed;
}

void draw_inside(Studio& studio) {
    AccuracyPage& page = page_of(studio);
    const auto now = page.thread ? page.thread->state() : AccuracyThread::State();
    if (now.ledger && now.ledger != page.shown) show(page, now.ledger, true);
    if (!page.shown && page.problem.empty()) read_known(page);
    dim_text(
        "How far the mock-up's picture is from the path tracer's, and how long it takes: one "
        "effect at one of its levels, all others at their dearest; and the qualities as they are. "
        "The line joins what nothing else beats in both; green is how the mock-up is drawn now.");
    draw_measuring(studio, now);
    if (!now.problem.empty()) warning_text(sentence(now.problem));
    if (!page.problem.empty()) warning_text(page.problem);
    if (!page.shown || page.levels.empty()) return;
    dim_text(measured_on(page, now.running || (now.ledger && !now.whole)));
    const float height = std::max(em(14.0f), 0.48f * ImGui::GetContentRegionAvail().y);
    const int pointed = draw_accuracy_chart(page.levels, page.on_front, page.pointed, height);
    name_last_item("accuracy:chart");
    draw_table(studio, pointed);
}

}  // namespace

void show_accuracy_page(Studio& studio, bool open) {
    AccuracyPage& page = page_of(studio);
    page.open = open;
    // What another run of the program has measured meanwhile
    if (open && !is_measuring_accuracy(studio)) {
        page.shown = nullptr;
        page.problem.clear();
        if (page.thread) page.thread.reset();
    }
}

bool is_measuring_accuracy(const Studio& studio) {
    const AccuracyPage& page = page_of(studio);
    return page.thread && page.thread->state().running;
}

void draw_accuracy_page(Studio& studio) {
    AccuracyPage& page = page_of(studio);
    if (!page.open) return;
    const ImVec2 room = ImGui::GetMainViewport()->WorkSize;
    ImGui::SetNextWindowPos(
        ImGui::GetMainViewport()->GetCenter(), ImGuiCond_Appearing, {0.5f, 0.5f});
    ImGui::SetNextWindowSize(
        {std::min(em(58.0f), 0.92f * room.x), std::min(em(48.0f), 0.92f * room.y)},
        ImGuiCond_Appearing);
    if (ImGui::Begin("What accuracy costs",
                     &page.open,
                     ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoSavedSettings)) {
        draw_inside(studio);
    }
    ImGui::End();
}

}  // namespace livery
