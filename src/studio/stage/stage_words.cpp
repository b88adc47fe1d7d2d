#include "studio/stage/stage_words.h"

#include <cfloat>
#include <cmath>
#include <string>

#include <fmt/format.h>
#include <imgui.h>

#include "studio/artwork/artwork_edit.h"
#include "studio/artwork/artwork_values.h"
#include "studio/kit/theme.h"
#include "studio/kit/ui_map.h"
#include "studio/kit/widgets.h"

namespace livery {

void draw_held_name(const Studio& studio, const StageFrame& stage) {
    if (!studio.showing_b || !studio.compared_look) return;
    const SessionLook* look = find_look(studio.session.document(), *studio.compared_look);
    if (!look) return;
    ImFont* font = large_font();
    const float pad = em(0.5f), width = stage.width - 6.0f * pad;
    ImGui::PushFont(font);
    const auto lines = fitted_lines("B   " + look->look.name, width, 1);
    ImGui::PopFont();
    const ImVec2 size = font->CalcTextSizeA(font->FontSize, FLT_MAX, 0.0f, lines.front().c_str());
    // At the lower right: notices and captions have the other corners.
    const ImVec2 at(std::round(stage.x + stage.width - size.x - 4.0f * pad),
                    stage.y + stage.height - size.y - 2.0f * pad);
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.AddRectFilled({at.x - 2.0f * pad, at.y - pad},
                       {at.x + size.x + 2.0f * pad, at.y + size.y + pad},
                       IM_COL32(0, 0, 0, 190),
                       em(0.25f));
    list.AddText(
        font, font->FontSize, at, ImGui::GetColorU32(colours::text), lines.front().c_str());
    name_rectangle("held-b-name", at.x, at.y, size.x, size.y);
}

void draw_placing(const Studio& studio, const StageFrame& stage) {
    if (!is_placing(studio)) return;
    const std::string text =
        fmt::format("Click where \"{}\" goes. Esc takes it back.",
                    shown_name(shown_artwork(studio)[*chosen_artwork(studio)]));
    const float pad = em(0.5f), width = stage.width - 4.0f * pad;
    const auto lines = fitted_lines(text, width - 2.0f * pad, 3);
    const float height = static_cast<float>(lines.size()) * ImGui::GetFontSize() * 1.15f;
    const ImVec2 low(stage.x + 2.0f * pad, stage.y + 2.0f * pad);
    ImGui::GetWindowDrawList()->AddRectFilled(
        low,
        {low.x + width, low.y + height + 2.0f * pad},
        ImGui::GetColorU32(ImVec4(colours::accent.x, colours::accent.y, colours::accent.z, 0.9f)),
        em(0.25f));
    centred_lines(lines, {low.x, low.y + pad}, width, colours::text);
}

}  // namespace livery
