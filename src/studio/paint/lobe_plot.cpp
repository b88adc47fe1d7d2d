#include "studio/paint/lobe_plot.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <imgui.h>

#include "core/colour.h"
#include "studio/kit/theme.h"
#include "studio/studio.h"

namespace livery {

namespace {

constexpr double kLeastDecades = 2.0, kMostDecades = 6.0;
/// A diffuse paint of a hundredth still shows.
constexpr double kUsualLowest = 1e-3;
constexpr double kSteepest_deg = 89.0;
constexpr ImU32 kComparedColour = IM_COL32(205, 150, 235, 255);
constexpr float kPi = std::numbers::pi_v<float>;

double largest(const std::vector<LobePoint>* curve) {
    double most = 0.0;
    if (!curve) return most;
    for (const LobePoint& point : *curve) {
        most = std::max(most, luminance_of_working(point.value));
    }
    return most;
}

/// 1, 2, 5, 10, 20, ...: the first that is not below.
double round_above(double value) {
    const double decade = std::pow(10.0, std::floor(std::log10(value)));
    for (const double step : {1.0, 2.0, 5.0}) {
        if (value <= step * decade) return step * decade;
    }
    return 10.0 * decade;
}

struct Dial {
    ImVec2 middle;
    float radius;

    ImVec2 at(double angle_rad, double share) const {
        const float r = radius * static_cast<float>(share);
        const auto angle = static_cast<float>(angle_rad);
        return {middle.x + r * std::sin(angle), middle.y - r * std::cos(angle)};
    }
};

void draw_half_circle(ImDrawList& list, const Dial& dial, double share, ImU32 colour) {
    list.PathArcTo(dial.middle, dial.radius * static_cast<float>(share), -kPi, 0.0f, 48);
    list.PathStroke(colour, 0, 1.0f);
}

void label_ring(ImDrawList& list, const Dial& dial, double share, double value, ImU32 colour) {
    const std::string text = fmt::format("{:g}", value);
    const ImVec2 size = ImGui::CalcTextSize(text.c_str());
    const float x = dial.middle.x + dial.radius * static_cast<float>(share);
    list.AddText({x - 0.5f * size.x, dial.middle.y + 1.0f}, colour, text.c_str());
}

void draw_grid(ImDrawList& list, const Dial& dial, const RadialScale& scale) {
    const ImU32 line = ImGui::GetColorU32(colours::line);
    const ImU32 words = ImGui::GetColorU32(colours::dim_text);
    for (int degrees = -90; degrees <= 90; degrees += 30) {
        list.AddLine(dial.middle, dial.at(degrees * std::numbers::pi / 180.0, 1.0), line);
    }
    if (scale.logarithmic) {
        const double decades = std::log10(scale.highest / scale.lowest);
        const int every = decades > 4.5 ? 2 : 1;
        const int count = static_cast<int>(std::lround(decades));
        for (int k = count; k > 0; --k) {
            const double value = scale.highest * std::pow(10.0, k - count);
            draw_half_circle(list, dial, scale.radius(value), line);
            if ((count - k) % every == 0) {
                label_ring(list, dial, scale.radius(value), value, words);
            }
        }
    } else {
        for (const double share : {0.5, 1.0}) {
            draw_half_circle(list, dial, share, line);
            label_ring(list, dial, share, share * scale.highest, words);
        }
    }
}

template <typename ValueOf>
void draw_curve(ImDrawList& list,
                const Dial& dial,
                const RadialScale& scale,
                const std::vector<LobePoint>& curve,
                ImU32 colour,
                float thickness,
                ValueOf value_of) {
    for (const LobePoint& point : curve) {
        list.PathLineTo(dial.at(point.theta_o_rad, scale.radius(value_of(point.value))));
    }
    list.PathStroke(colour, 0, thickness);
}

void draw_light(ImDrawList& list, const Dial& dial, double light_deg) {
    const double angle = -light_deg * std::numbers::pi / 180.0;
    const ImU32 colour = ImGui::GetColorU32(colours::warning);
    const float em_px = em(1.0f);
    const ImVec2 head = dial.at(angle, 1.0);
    list.AddLine(dial.at(angle, 0.72), head, colour, 1.5f);
    list.AddCircleFilled(head, 0.28f * em_px, colour, 16);
}

void tell_value(const LobePlot& plot, const Dial& dial, double light_deg) {
    const ImVec2 pointer = ImGui::GetIO().MousePos;
    const double angle =
        std::atan2(pointer.x - dial.middle.x, std::max(dial.middle.y - pointer.y, 0.0f));
    const auto value_at = [&](const std::vector<LobePoint>& curve) {
        const auto next = std::lower_bound(
            curve.begin(), curve.end() - 1, angle, [](const LobePoint& point, double x) {
                return point.theta_o_rad < x;
            });
        return luminance_of_working(next->value);
    };
    std::string text = fmt::format("Light from {:.0f}°: drag to turn it.", light_deg);
    if (plot.curve && !plot.curve->empty()) {
        text += fmt::format("\nSeen from {:.0f}°: {:.3g} per steradian",
                            angle * 180.0 / std::numbers::pi,
                            value_at(*plot.curve));
        if (plot.compared && !plot.compared->empty()) {
            text += fmt::format(", compared {:.3g}", value_at(*plot.compared));
        }
    }
    tooltip(text + "\nThe white line is the luminance, the thin ones red, green and blue.");
}

}  // namespace

double RadialScale::radius(double value) const {
    if (!(value > 0.0)) return 0.0;
    const double share =
        logarithmic ? std::log(value / lowest) / std::log(highest / lowest) : value / highest;
    return std::clamp(share, 0.0, 1.0);
}

RadialScale scale_for(const LobePlot& plot) {
    RadialScale scale;
    scale.logarithmic = plot.logarithmic;
    const double most = std::max(largest(plot.curve), largest(plot.compared));
    if (!(most > 0.0) || !std::isfinite(most)) return scale;
    if (!plot.logarithmic) {
        scale.highest = round_above(most);
        return scale;
    }
    scale.highest = std::pow(10.0, std::ceil(std::log10(most) - 1e-9));
    const double decades =
        std::clamp(std::log10(scale.highest / kUsualLowest), kLeastDecades, kMostDecades);
    scale.lowest = scale.highest * std::pow(10.0, -std::round(decades));
    return scale;
}

bool draw_lobe_plot(const LobePlot& plot, double& light_deg, float width) {
    const float margin = em(0.6f);
    ImGui::PushFont(small_font());
    const float label = ImGui::GetTextLineHeight() + 2.0f;
    const Dial dial{{ImGui::GetCursorScreenPos().x + 0.5f * width,
                     ImGui::GetCursorScreenPos().y + 0.5f * width - 0.6f * margin},
                    0.5f * width - margin};
    ImGui::InvisibleButton("##lobe", {width, dial.radius + 0.4f * margin + label});
    name_last_item("lobe-plot");
    bool turned = false;
    if (ImGui::IsItemActive()) {
        const ImVec2 pointer = ImGui::GetIO().MousePos;
        const double angle = std::abs(
            std::atan2(pointer.x - dial.middle.x, std::max(dial.middle.y - pointer.y, 1e-3f)));
        const double wanted =
            std::clamp(std::round(angle * 180.0 / std::numbers::pi), 0.0, kSteepest_deg);
        turned = wanted != light_deg;
        light_deg = wanted;
    }
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const RadialScale scale = scale_for(plot);
    draw_grid(list, dial, scale);
    if (plot.curve) {
        const ImU32 channels[] = {
            IM_COL32(230, 90, 80, 190), IM_COL32(90, 200, 100, 190), IM_COL32(100, 140, 255, 190)};
        for (glm::length_t c = 0; c < 3; ++c) {
            draw_curve(list, dial, scale, *plot.curve, channels[c], 1.0f, [&](const glm::dvec3& v) {
                return (rec709_from_working() * v)[c];
            });
        }
    }
    if (plot.compared) {
        draw_curve(list, dial, scale, *plot.compared, kComparedColour, 1.5f, luminance_of_working);
    }
    if (plot.curve) {
        const ImU32 white = ImGui::GetColorU32(colours::text);
        draw_curve(list, dial, scale, *plot.curve, white, 1.5f, luminance_of_working);
    }
    draw_light(list, dial, light_deg);
    ImGui::PopFont();
    if (ImGui::IsItemHovered()) tell_value(plot, dial, light_deg);
    return turned;
}

}  // namespace livery
