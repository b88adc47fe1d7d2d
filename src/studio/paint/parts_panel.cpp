#include "studio/paint/parts_panel.h"

#include <algorithm>

#include <imgui.h>

namespace livery {

std::optional<std::size_t> chosen_part(const Studio& studio) {
    if (!studio.product || studio.product->mesh.parts.empty()) return std::nullopt;
    const auto& parts = studio.product->mesh.parts;
    if (studio.selected_part && *studio.selected_part >= 0 &&
        static_cast<std::size_t>(*studio.selected_part) < parts.size()) {
        return static_cast<std::size_t>(*studio.selected_part);
    }
    const auto body = std::find_if(
        parts.begin(), parts.end(), [](const Part& part) { return part.name == "body"; });
    return body == parts.end() ? 0 : static_cast<std::size_t>(body - parts.begin());
}

std::string worn_paint(const Look& look, const std::string& part) {
    auto found = look.parts.find(part);
    if (found == look.parts.end()) found = look.parts.find("*");
    return found == look.parts.end() ? "" : found->second;
}

void draw_parts_panel(Studio& studio) {
    heading("Parts");
    const Document document = shown_document(studio);
    const SessionLook* look = find_look(document, studio.shown_look);
    if (!look || !studio.product) return;
    studio.hovered_part.reset();
    const auto& parts = studio.product->mesh.parts;
    for (int i = 0; i < static_cast<int>(parts.size()); ++i) {
        const std::string& name = parts[static_cast<std::size_t>(i)].name;
        ImGui::PushID(i);
        const ImVec2 from = ImGui::GetCursorScreenPos();
        const float width = ImGui::GetContentRegionAvail().x;
        const float height = 2.0f * ImGui::GetTextLineHeight() + em(0.45f);
        if (ImGui::Selectable("##part", studio.selected_part == i, 0, {width, height})) {
            select_part(studio, i);
        }
        name_last_item("part:" + name);
        if (ImGui::IsItemHovered()) studio.hovered_part = i;
        ImDrawList& list = *ImGui::GetWindowDrawList();
        const ImVec4 clip(from.x, from.y, from.x + width, from.y + height);
        const ImVec2 at(from.x + em(0.5f), from.y + em(0.15f));
        list.AddText(nullptr,
                     0.0f,
                     at,
                     ImGui::GetColorU32(colours::text),
                     name.c_str(),
                     nullptr,
                     0.0f,
                     &clip);
        const std::string own = worn_paint(look->look, name);
        const std::string paint = own.empty() ? "as in its file" : own;
        list.AddText(
            small_font(),
            small_font()->FontSize,
            {at.x, at.y + ImGui::GetTextLineHeight() + em(0.1f)},
            ImGui::GetColorU32(studio.selected_part == i ? colours::text : colours::dim_text),
            paint.c_str(),
            nullptr,
            0.0f,
            &clip);
        ImGui::PopID();
    }
}

Panel parts_panel() {
    return {.name = "parts", .place = PanelPlace::left, .draw = draw_parts_panel};
}

}  // namespace livery
