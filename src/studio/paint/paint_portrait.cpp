#include "studio/paint/paint_portrait.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include "appearance/paint_bsdf.h"
#include "appearance/parameter_table.h"
#include "core/colour.h"
#include "core/error.h"
#include "studio/paint/paint_panel.h"
#include "studio/paint/swatches.h"

namespace livery {

namespace {

PaintPortraitState& state_of(Studio& studio) {
    return studio.panels.of<PaintPanelState>().portrait;
}

PaintPortrait portrait_of(const Material& material, double light_rad) {
    return {material, paint_figures(material), lobe_curve(material, light_rad)};
}

/// One at a time: while a slider is dragged the newest is asked for when the one before is there.
void ask_for_portrait(Studio& studio, const Material& material) {
    PaintPortraitState& state = state_of(studio);
    if (state.working || !studio.background || studio.opening) return;
    PortraitKey key;
    key.own = reflectance_numbers(material);
    if (state.compared) key.other = reflectance_numbers(*state.compared);
    key.light_rad = state.light_deg * std::numbers::pi / 180.0;
    if (key == state.asked) return;
    state.asked = key;
    state.working = true;
    studio.background->run(
        [&state, material, other = state.compared, light_rad = key.light_rad](
            const Progress&) -> Background::Then {
            PaintPortrait own = portrait_of(material, light_rad);
            std::optional<PaintPortrait> compared;
            std::optional<ReflectanceDifference> difference;
            if (other) {
                compared = portrait_of(*other, light_rad);
                difference = difference_of(reflectance_of(material), reflectance_of(*other));
            }
            return [&state, own = std::move(own), compared = std::move(compared), difference] {
                state.own = own;
                state.other = compared;
                state.difference = difference;
                state.problem.clear();
                state.working = false;
            };
        },
        [&state](const std::exception_ptr& failure) {
            state.problem = in_words(failure);
            state.working = false;
        });
}

std::string lab_text(const glm::dvec3& lab) {
    return fmt::format("L* {:.1f}   a* {:.1f}   b* {:.1f}", lab.x, lab.y, lab.z);
}

/// Five patches side by side; the compared paint's touch them from below.
void draw_five_angles(const PaintPortraitState& state) {
    const float width = ImGui::GetContentRegionAvail().x;
    const float gap = em(0.2f), patch = (width - 4.0f * gap) / 5.0f, height = em(1.7f);
    ImDrawList& list = *ImGui::GetWindowDrawList();
    for (std::size_t k = 0; k < kAspecularAngles_deg.size(); ++k) {
        if (k > 0) ImGui::SameLine(0.0f, gap);
        const ImVec2 corner = ImGui::GetCursorScreenPos();
        const glm::dvec3& own = state.own->figures.lab[k];
        const std::string angle = fmt::format("{:g}", kAspecularAngles_deg[k]);
        ImGui::BeginGroup();
        ImGui::Dummy({patch, state.other ? 1.7f * height : height});
        list.AddRectFilled(corner, {corner.x + patch, corner.y + height}, screen_colour(own));
        std::string more =
            fmt::format("{}° from the mirror direction, light at 45°\n{}", angle, lab_text(own));
        if (state.other) {
            const glm::dvec3& other = state.other->figures.lab[k];
            list.AddRectFilled({corner.x, corner.y + height},
                               {corner.x + patch, corner.y + 1.7f * height},
                               screen_colour(other));
            more += fmt::format(
                "\ncompared: {}\nCIEDE2000 {:.1f}", lab_text(other), ciede2000(own, other));
        }
        ImGui::PushFont(small_font());
        ImGui::TextColored(colours::dim_text, "%s°", angle.c_str());
        ImGui::SameLine(0.0f, em(0.35f));
        ImGui::Text("%.0f", own.x);
        ImGui::PopFont();
        ImGui::EndGroup();
        name_last_item("angle:" + angle);
        tooltip(more);
    }
}

std::string flop_text(const PaintFigures& figures) {
    return figures.flop ? fmt::format("{:.1f}", *figures.flop) : "none";
}

void draw_figures(const PaintPortraitState& state) {
    const PaintFigures& own = state.own->figures;
    std::string text = fmt::format(
        "Flop {}    Gloss 20° {:.0f}    60° {:.0f}", flop_text(own), own.gloss_20, own.gloss_60);
    ImGui::TextUnformatted(text.c_str());
    name_last_item("paint-figures");
    tooltip(
        "Flop: how much lighter the paint is near the mirror direction than away from it; 0 "
        "solid, 15 and more a strong effect. Gloss: what a glossmeter reads; polished black "
        "glass has 100.");
    if (!state.other || !state.difference) return;
    const PaintFigures& other = state.other->figures;
    dim_text(fmt::format("Compared: flop {}, gloss 20° {:.0f}, 60° {:.0f}",
                         flop_text(other),
                         other.gloss_20,
                         other.gloss_60));
    const bool same =
        reflectance_numbers(state.own->material) == reflectance_numbers(state.other->material);
    ImGui::TextUnformatted(same ? "The same paint."
                                : fmt::format("Difference on a lit sphere: {:.1f} (95%: {:.1f})",
                                              state.difference->de00_mean,
                                              state.difference->de00_p95)
                                      .c_str());
    name_last_item("paint-difference");
    tooltip(
        "CIEDE2000, mean over a sphere under four lights; 1 is about what one sees side by "
        "side.");
}

void load_compared(Studio& studio, const std::filesystem::path& file) {
    PaintPortraitState& state = state_of(studio);
    studio.background->run(
        [&state, file](const Progress&) -> Background::Then {
            return [&state, material = with_measured_read(read_paint_file(file))] {
                state.compared = material;
            };
        },
        [&studio](const std::exception_ptr& failure) {
            tell_error(studio,
                       "There is nothing to compare with.",
                       in_words(failure),
                       "Choose another file.");
        });
}

void draw_choices(Studio& studio) {
    PaintPortraitState& state = state_of(studio);
    if (ImGui::IsWindowAppearing()) {
        state.search.clear();
        focus_next_field("##search");
    }
    ImGui::SetNextItemWidth(-1.0f);
    ImGui::InputTextWithHint("##search", "Name, family or colour", &state.search);
    name_last_item("compare-search");
    if (ImGui::Selectable("Nothing", !state.compared.has_value())) state.compared.reset();
    name_last_item("compare:nothing");
    if (named(ImGui::Selectable("A file: measured, or a paint…"), "compare:file")) {
        studio.file_dialog->ask({FileQuestion::Kind::open,
                                 "Compare with",
                                 "Compare",
                                 {".binary", ".brdf", ".csv", ".json"},
                                 false,
                                 {},
                                 [&studio](const auto& file) { load_compared(studio, file); }});
    }
    ImGui::Separator();
    draw_paint_list(studio,
                    state.search,
                    "compare",
                    state.compared ? state.compared->name : "",
                    [&](const Material& paint, bool picked) {
                        if (picked) state.compared = paint;
                        tooltip(paint.provenance);
                    });
}

void draw_comparison(Studio& studio) {
    PaintPortraitState& state = state_of(studio);
    row_label("Compare with");
    const std::string shown = state.compared ? state.compared->name : "nothing";
    ImGui::SetNextItemWidth(-1.0f);
    const bool open = ImGui::BeginCombo("##compare", shown.c_str(), ImGuiComboFlags_HeightLarge);
    name_last_item("paint-compare");
    if (open) {
        draw_choices(studio);
        ImGui::EndCombo();
    } else {
        tooltip(
            "Another paint, or reflectance that was measured: its lobe is drawn in violet, its "
            "colours touch this paint's.");
    }
}

}  // namespace

void draw_paint_portrait(Studio& studio, const Material& material) {
    PaintPortraitState& state = state_of(studio);
    ask_for_portrait(studio, material);
    const float sphere = em(6.0f), gap = em(0.5f);
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    const float width = ImGui::GetContentRegionAvail().x;
    ImGui::BeginGroup();
    ImGui::Dummy({sphere, sphere});
    draw_swatch(studio, material, corner, sphere);
    if (state.compared) {
        const float small = 0.45f * sphere;
        draw_swatch(
            studio, *state.compared, {corner.x + sphere - small, corner.y + sphere - small}, small);
    }
    ImGui::Checkbox("Log", &state.logarithmic);
    name_last_item("lobe-log");
    tooltip("The plot's radius: powers of ten, or in proportion.");
    ImGui::EndGroup();
    ImGui::SameLine(0.0f, gap);
    LobePlot plot;
    plot.logarithmic = state.logarithmic;
    if (state.own) plot.curve = &state.own->curve;
    if (state.other) plot.compared = &state.other->curve;
    draw_lobe_plot(plot, state.light_deg, width - sphere - gap);
    if (state.own) {
        draw_five_angles(state);
        draw_figures(state);
    }
    if (!state.problem.empty()) warning_text(state.problem);
    draw_comparison(studio);
}

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
