#include "studio/light/accuracy_page.h"

#include <algorithm>
#include <set>
#include <utility>

#include <fmt/format.h>
#include <imgui.h>

#include "core/error.h"
#include "ledger/accuracy/accuracy.h"
#include "ledger/svg.h"
#include "scene/effects.h"
#include "studio/studio.h"

namespace livery {

namespace {

unsigned packed(const ImVec4& colour, float alpha = 1.0f) {
    ImVec4 with = colour;
    with.w *= alpha;
    return ImGui::ColorConvertFloat4ToU32(with);
}

struct Chart {
    LogAxis x, y;
    ImVec2 at(const AccuracyLevel& level) const {
        return {static_cast<float>(x.at(std::max(level.solve_ms, x.low))),
                static_cast<float>(y.at(std::max(level.p95, y.low)))};
    }
};

/// A third beyond the least and the largest on either side.
std::pair<double, double> range_of(const std::vector<AccuracyLevel>& levels,
                                   double AccuracyLevel::*value,
                                   double least) {
    double low = 1e30, high = least;
    for (const AccuracyLevel& level : levels) {
        low = std::min(low, level.*value);
        high = std::max(high, level.*value);
    }
    low = std::max(low, least);
    return {0.75 * low, std::max(1.33 * high, 2.0 * low)};
}

void draw_grid(ImDrawList& to, const Chart& chart) {
    const auto left = static_cast<float>(chart.x.begin_px);
    const auto right = static_cast<float>(chart.x.end_px);
    const auto bottom = static_cast<float>(chart.y.begin_px);
    const auto top = static_cast<float>(chart.y.end_px);
    const auto colour = [](bool decade) { return packed(colours::line, decade ? 1.0f : 0.45f); };
    const auto words = [&](ImVec2 place, const std::string& text) {
        to.AddText(place, packed(colours::dim_text), text.c_str());
    };
    ImGui::PushFont(small_font());
    for (const auto& [ms, decade] : ticks_of(chart.x)) {
        const auto x = static_cast<float>(chart.x.at(ms));
        to.AddLine({x, top}, {x, bottom}, colour(decade));
        const std::string text =
            ms >= 1000.0 ? fmt::format("{:g} s", ms / 1000.0) : fmt::format("{:g} ms", ms);
        words({x - 0.5f * ImGui::CalcTextSize(text.c_str()).x, bottom + em(0.3f)}, text);
    }
    for (const auto& [error, decade] : ticks_of(chart.y)) {
        const auto y = static_cast<float>(chart.y.at(error));
        to.AddLine({left, y}, {right, y}, colour(decade));
        const std::string text = fmt::format("{:g}", error);
        const ImVec2 size = ImGui::CalcTextSize(text.c_str());
        words({left - size.x - em(0.4f), y - 0.5f * size.y}, text);
    }
    const std::string along = "what a new light takes";
    words({right - ImGui::CalcTextSize(along.c_str()).x, bottom + em(1.5f)}, along);
    words({left, top - em(1.3f)}, "CIEDE2000 at the 95th percentile");
    ImGui::PopFont();
}

bool is_quality(const AccuracyLevel& level) { return level.effect == kQualityRows; }

void draw_front(ImDrawList& to,
                const Chart& chart,
                const std::vector<AccuracyLevel>& levels,
                const std::vector<bool>& on_front) {
    std::vector<ImVec2> line;
    for (std::size_t k = 0; k < levels.size(); ++k) {
        if (on_front[k]) line.push_back(chart.at(levels[k]));
    }
    std::sort(line.begin(), line.end(), [](ImVec2 a, ImVec2 b) { return a.x < b.x; });
    to.AddPolyline(line.data(),
                   static_cast<int>(line.size()),
                   packed(colours::accent, 0.8f),
                   ImDrawFlags_None,
                   em(0.12f));
}

/// "shadows: sharp"; a quality by its name alone.
std::string label_of(const AccuracyLevel& level) {
    return is_quality(level) ? level.level : level.effect + ": " + level.level;
}

/// Beside its mark, on the side where there is room.
void draw_label(ImDrawList& to, const Chart& chart, const AccuracyLevel& level) {
    const std::string text = label_of(level);
    const ImVec2 at = chart.at(level), size = ImGui::CalcTextSize(text.c_str());
    const bool left = at.x + em(0.6f) + size.x > static_cast<float>(chart.x.end_px);
    const ImVec2 place{left ? at.x - em(0.6f) - size.x : at.x + em(0.6f), at.y - 1.1f * size.y};
    to.AddRectFilled({place.x - em(0.15f), place.y},
                     {place.x + size.x + em(0.15f), place.y + size.y},
                     packed(colours::panel, 0.85f));
    to.AddText(place, packed(colours::text), text.c_str());
}

/// The width of the row, `height` pixels. The level whose mark the pointer is at, else -1;
/// `pointed` is drawn larger.
int draw_accuracy_chart(const std::vector<AccuracyLevel>& levels,
                        const std::vector<bool>& on_front,
                        int pointed,
                        float height) {
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    const float width = ImGui::GetContentRegionAvail().x;
    ImGui::InvisibleButton("##chart", {width, height});
    const bool hovered = ImGui::IsItemHovered();
    ImDrawList& to = *ImGui::GetWindowDrawList();
    const auto [x_low, x_high] = range_of(levels, &AccuracyLevel::solve_ms, 1.0);
    const auto [y_low, y_high] = range_of(levels, &AccuracyLevel::p95, 0.01);
    const auto px = [](float value) { return static_cast<double>(value); };
    const Chart chart{{x_low, x_high, px(corner.x + em(2.6f)), px(corner.x + width - em(1.0f))},
                      {y_low, y_high, px(corner.y + height - em(3.0f)), px(corner.y + em(1.6f))}};
    draw_grid(to, chart);
    draw_front(to, chart, levels, on_front);

    int nearest = -1;
    float nearest2 = em(1.0f) * em(1.0f);
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    for (std::size_t k = 0; k < levels.size(); ++k) {
        const ImVec2 at = chart.at(levels[k]);
        const bool quality = is_quality(levels[k]);
        const ImVec4& colour = quality       ? colours::text
                               : on_front[k] ? colours::accent
                                             : colours::dim_text;
        const float radius =
            em(quality ? 0.34f : 0.24f) * (static_cast<int>(k) == pointed ? 1.6f : 1.0f);
        to.AddCircleFilled(at, radius + em(0.07f), packed(colours::panel));
        to.AddCircleFilled(at, radius, packed(colour));
        const float dx = mouse.x - at.x, dy = mouse.y - at.y;
        if (hovered && dx * dx + dy * dy < nearest2) {
            nearest2 = dx * dx + dy * dy;
            nearest = static_cast<int>(k);
        }
    }
    for (std::size_t k = 0; k < levels.size(); ++k) {
        if (is_quality(levels[k]) || static_cast<int>(k) == pointed) {
            draw_label(to, chart, levels[k]);
        }
    }
    return nearest;
}

AccuracyPage& page_of(const Studio& studio) { return studio.panels.of<AccuracyPage>(); }

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
        if (button("Stop", "accuracy:stop")) page.thread->stop();
        ImGui::SameLine();
        progress_bar(now.fraction, now.doing);
        return;
    }
    const bool presenting = is_editing_locked(studio);
    begin_disabled(presenting);
    if (button("Measure on this machine", "accuracy:measure")) {
        if (!page.thread) page.thread = std::make_unique<AccuracyThread>(wake_main_thread);
        page.problem.clear();
        page.thread->measure();
    }
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
    if (begin_page("What accuracy costs", page.open, {em(58.0f), em(48.0f)})) draw_inside(studio);
    ImGui::End();
}

Panel accuracy_panel() {
    return {
        .name = "accuracy",
        .place = PanelPlace::page,
        .draw = draw_accuracy_page,
        .is_open = [](const Studio& s) { return page_of(s).open; },
        .show = show_accuracy_page,
        .stop = [](Studio& s) { page_of(s).thread.reset(); },
        .esc_closes = true,
        .next_change_s =
            [](const Studio& s) { return is_measuring_accuracy(s) ? s.now_s + kProgress_s : 0.0; },
        .actions =
            [] {
                return std::vector{line_above(
                    panel_action("accuracy-page", "accuracy", "View", "What accuracy costs"))};
            }};
}

}  // namespace livery
