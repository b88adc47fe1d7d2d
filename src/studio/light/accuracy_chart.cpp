#include "studio/light/accuracy_chart.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>
#include <imgui.h>

#include "ledger/svg.h"
#include "studio/kit/theme.h"
#include "studio/kit/widgets.h"
#include "studio/kit/words.h"

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

}  // namespace

std::string label_of(const AccuracyLevel& level) {
    return is_quality(level) ? level.level : level.effect + ": " + level.level;
}

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

}  // namespace livery
