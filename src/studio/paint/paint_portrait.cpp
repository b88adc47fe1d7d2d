#include "studio/paint/paint_portrait.h"

#include <algorithm>
#include <filesystem>
#include <numbers>

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include "appearance/paint_bsdf.h"
#include "appearance/parameter_table.h"
#include "core/colour.h"
#include "core/error.h"
#include "studio/kit/background.h"
#include "studio/kit/file_dialog.h"
#include "studio/kit/tab_order.h"
#include "studio/kit/theme.h"
#include "studio/kit/widgets.h"
#include "studio/paint/lobe_plot.h"
#include "studio/paint/paint_choice.h"
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

std::string words_of(const std::exception_ptr& failure) {
    try {
        std::rethrow_exception(failure);
    } catch (const std::exception& error) {
        return error.what();
    }
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
            state.problem = words_of(failure);
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
            notify(studio,
                   {Notice::Level::error,
                    "There is nothing to compare with.",
                    words_of(failure),
                    "Choose another file."});
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
    if (ImGui::Selectable("A file: measured, or a paint…")) {
        studio.file_dialog->ask({FileQuestion::Kind::open,
                                 "Compare with",
                                 "Compare",
                                 {".binary", ".brdf", ".csv", ".json"},
                                 false,
                                 {},
                                 [&studio](const auto& file) { load_compared(studio, file); }});
    }
    name_last_item("compare:file");
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

}  // namespace livery
