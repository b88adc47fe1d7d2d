#include "studio/paint/paint_colour_row.h"

#include <exception>

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include "appearance/fit/recolour.h"
#include "appearance/parameter_table.h"
#include "core/error.h"
#include "studio/kit/file_dialog.h"
#include "studio/kit/theme.h"
#include "studio/kit/widgets.h"
#include "studio/paint/paint_panel.h"
#include "studio/paint/paint_parameters.h"
#include "studio/users_library.h"

namespace livery {

namespace {

constexpr const char* kWays =
    "The colour under light from 45 degrees, seen from straight above: #b01020, rgb(176, 16, 32), "
    "a name as in CSS (tomato), lab:45,30,-20 or xyz:20.1,15.2,5 (D65, 10 degrees; white has "
    "Y = 100).";

/// Worked out once for each paint and colour.
const Recoloured& recoloured(PaintColourState& state, const Material& paint, glm::dvec3 lab10) {
    std::vector<double> key = reflectance_numbers(paint);
    key.insert(key.end(), {lab10.x, lab10.y, lab10.z});
    if (!state.made || key != state.made_of) {
        state.made = with_colour(paint, lab10);
        state.made->material.name = paint.name;
        state.made_of = std::move(key);
    }
    return *state.made;
}

EditPaint edit_of(const Studio& studio, const Recoloured& made) {
    const PaintPanelState& panel = studio.panels.of<PaintPanelState>();
    return {panel.look, panel.part_name, made.material};
}

void draw_typed(Studio& studio, const Material& paint) {
    PaintColourState& state = studio.panels.of<PaintPanelState>().colour;
    row_label("Colour at 45°");
    const glm::dvec3 face = drawn_face_lab(paint);
    const std::string its_own = fmt::format("lab:{:.1f},{:.1f},{:.1f}", face.x, face.y, face.z);
    if (!state.typing) state.text = its_own;
    ImGui::SetNextItemWidth(-1.0f);
    ImGui::InputText("##colour", &state.text, ImGuiInputTextFlags_AutoSelectAll);
    name_last_item("paint-colour");
    tooltip(kWays);
    const bool edited = ImGui::IsItemDeactivatedAfterEdit();
    state.typing = ImGui::IsItemActive();
    state.edited = (state.typing && state.edited) || ImGui::IsItemEdited();
    // What was put back is no edit, though the text is rounded.
    if ((!(state.typing && state.edited) && !edited) || state.text == its_own) return;
    const auto lab = colour_in(state.text);
    if (!lab) {
        if (edited) {
            notify(studio,
                   {Notice::Level::warning,
                    fmt::format("\"{}\" is no colour.", state.text),
                    "",
                    "Type one as #b01020, rgb(176, 16, 32), tomato, lab:45,30,-20 or "
                    "xyz:20.1,15.2,5."});
        }
        return;
    }
    const Recoloured& made = recoloured(state, paint, *lab);
    edit_with_last_item(studio, edit_of(studio, made));
    if (!made.reached) warning_text(made.why_not);
}

std::string short_lab_text(const glm::dvec3& lab) {
    return fmt::format("{:.0f}, {:.0f}, {:.0f}", lab.x, lab.y, lab.z);
}

/// As long as the paint is what came of it: a colour that was missed is not forgotten.
void draw_asked_for(const Material& paint) {
    const auto asked = colour_record(paint.provenance);
    if (!asked) return;
    if (asked->de00 <= kColourReached) {
        dim_text(fmt::format("Asked for L*a*b* {}: CIEDE2000 {:.1f} from it.",
                             short_lab_text(asked->asked_lab10),
                             asked->de00));
    } else {
        warning_text(fmt::format(
            "Not the colour that was asked for: L*a*b* {} became {}, CIEDE2000 {:.1f} from it. "
            "This finish comes no nearer.",
            short_lab_text(asked->asked_lab10),
            short_lab_text(asked->came_lab10),
            asked->de00));
    }
    name_last_item("paint-colour-asked");
}

void ask_for_chips(Studio& studio) {
    studio.file_dialog->ask({FileQuestion::Kind::open,
                             "Read colour chips",
                             "Read",
                             {".csv"},
                             false,
                             {},
                             [&studio](const auto& file) {
                                 PaintColourState& state =
                                     studio.panels.of<PaintPanelState>().colour;
                                 try {
                                     state.chips = read_colour_chips(file);
                                     state.chips_file = file.filename().string();
                                 } catch (const FileError& error) {
                                     notify(studio,
                                            {Notice::Level::error,
                                             "The colour chips were not read.",
                                             error.what(),
                                             "A chip has a name, and L, a, b or X, Y, Z or hex."});
                                 }
                             }});
}

void draw_chips(Studio& studio, const Material& paint) {
    PaintColourState& state = studio.panels.of<PaintPanelState>().colour;
    row_label("Colour chips");
    ImGui::SetNextItemWidth(-1.0f);
    const std::string shown = state.chips.empty()
                                  ? "none read"
                                  : fmt::format("{} in {}", state.chips.size(), state.chips_file);
    const bool open = ImGui::BeginCombo("##chips", shown.c_str(), ImGuiComboFlags_HeightLarge);
    name_last_item("paint-chips");
    if (!open) {
        tooltip(
            "Gives this finish a colour of your own chart: a CSV with the column name, and "
            "L, a, b or X, Y, Z or hex.");
        return;
    }
    if (ImGui::Selectable("Read a file…")) ask_for_chips(studio);
    name_last_item("chip:file");
    ImGui::Separator();
    for (const ColourChip& chip : state.chips) {
        const ImVec2 corner = ImGui::GetCursorScreenPos();
        const float side = ImGui::GetTextLineHeight();
        const bool picked = ImGui::Selectable(("      " + chip.name + "##" + chip.name).c_str());
        name_last_item("chip:" + chip.name);
        ImGui::GetWindowDrawList()->AddRectFilled(
            corner, {corner.x + side, corner.y + side}, screen_colour(chip.lab10));
        if (!ImGui::IsItemHovered() && !picked) continue;
        const Recoloured& made = recoloured(state, paint, chip.lab10);
        tooltip(made.reached ? fmt::format("CIEDE2000 {:.2f} from the chip", made.de00)
                             : made.why_not);
        if (picked) {
            commit(studio, edit_of(studio, made));
        } else {
            try_out(studio, edit_of(studio, made));
        }
    }
    ImGui::EndCombo();
}

}  // namespace

void draw_paint_colour_row(Studio& studio, const Material& paint) {
    if (is_measured(paint) || is_translucent(paint)) return;  // their colour is no parameter
    draw_typed(studio, paint);
    if (!studio.panels.of<PaintPanelState>().colour.typing) draw_asked_for(paint);
    draw_chips(studio, paint);
}

}  // namespace livery
