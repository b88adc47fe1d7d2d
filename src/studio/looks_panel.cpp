// The looks of the session: shown, renamed, moved, chosen as B.
#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include "studio/kit/tab_order.h"
#include "studio/kit/theme.h"
#include "studio/kit/widgets.h"
#include "studio/studio.h"

namespace livery {

namespace {

/// The name while it is typed; kept here because it is nobody else's business.
std::string typed_name;

void draw_name_field(Studio& studio, const SessionLook& look, float width) {
    const bool first = !ImGui::IsPopupOpen("##naming") && typed_name.empty();
    if (first) {
        typed_name = look.look.name;
        focus_next_field("##name");
    }
    ImGui::SetNextItemWidth(width);
    const bool entered =
        ImGui::InputText("##name",
                         &typed_name,
                         ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_AutoSelectAll);
    name_last_item("look-name");
    const bool left = ImGui::IsItemDeactivated();
    if (!entered && !left) return;
    const bool gave_up = !entered && ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape));
    studio.renaming_look.reset();
    if (!gave_up && !typed_name.empty() && typed_name != look.look.name) {
        commit(studio, RenameLook{look.id, typed_name});
    }
    typed_name.clear();
}

void draw_row_menu(Studio& studio, const SessionLook& look, int place, int count) {
    if (!ImGui::BeginPopupContextItem("row")) return;
    if (ImGui::MenuItem("Duplicate", "Ctrl+D")) commit(studio, DuplicateLook{look.id});
    if (ImGui::MenuItem("Rename", "F2")) studio.renaming_look = look.id;
    if (ImGui::MenuItem("Compare with this one", nullptr, studio.compared_look == look.id)) {
        studio.compared_look = look.id;
        studio.chose_compared_look = true;
    }
    ImGui::Separator();
    if (ImGui::MenuItem("Move up", nullptr, false, place > 0)) {
        commit(studio, MoveLook{look.id, place - 1});
    }
    if (ImGui::MenuItem("Move down", nullptr, false, place + 1 < count)) {
        commit(studio, MoveLook{look.id, place + 1});
    }
    ImGui::Separator();
    if (ImGui::MenuItem("Delete", "Del", false, count > 1)) commit(studio, DeleteLook{look.id});
    ImGui::EndPopup();
}

/// The small letter at a row's end: A is what is shown, B what it is compared with.
void draw_compare_mark(Studio& studio, const SessionLook& look) {
    const bool is_a = look.id == studio.shown_look, is_b = studio.compared_look == look.id;
    ImGui::PushStyleColor(
        ImGuiCol_Text,
        is_a || is_b ? colours::text : ImGui::GetStyleColorVec4(ImGuiCol_TextDisabled));
    ImGui::PushStyleColor(ImGuiCol_Button, is_b ? colours::raised : ImVec4(0, 0, 0, 0));
    if (ImGui::Button(is_a ? "A" : "B", {ImGui::GetFrameHeight(), 0.0f}) && !is_a) {
        studio.compared_look = look.id;
        studio.chose_compared_look = true;
        keep_shown_looks_valid(studio);
    }
    ImGui::PopStyleColor(2);
    name_last_item(fmt::format("look-b:{}", look.id));
    tooltip(is_a ? "Shown: A of the comparison."
                 : "Compare with this look: it is B. Hold Space to see it, W wipes.");
}

void draw_row(Studio& studio, const SessionLook& look, int place, int count) {
    ImGui::PushID(look.id);
    const float height = ImGui::GetFrameHeight();
    const float width = ImGui::GetContentRegionAvail().x - height - ImGui::GetStyle().ItemSpacing.x;
    if (studio.renaming_look == look.id) {
        draw_name_field(studio, look, width);
    } else {
        ImGui::PushStyleVar(ImGuiStyleVar_SelectableTextAlign, {0.0f, 0.5f});
        const std::string number =
            place < 9 ? fmt::format(" {}   ", place + 1) : std::string("      ");
        const float room = width - ImGui::CalcTextSize(number.c_str()).x;
        const auto lines = fitted_lines(look.look.name, room, 1);
        const std::string name = lines.empty() ? std::string() : lines[0];
        if (ImGui::Selectable((number + name + "###row").c_str(),
                              look.id == studio.shown_look,
                              ImGuiSelectableFlags_AllowDoubleClick,
                              {width, height})) {
            stop_trying(studio);
            show_look(studio, look.id);
            if (ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left)) studio.renaming_look = look.id;
        }
        ImGui::PopStyleVar();
        name_last_item(fmt::format("look:{}", look.id));
        if (name != look.look.name) tooltip(look.look.name);
        draw_row_menu(studio, look, place, count);
    }
    ImGui::SameLine();
    draw_compare_mark(studio, look);
    ImGui::PopID();
}

}  // namespace

void draw_looks_panel(Studio& studio) {
    heading("Looks");
    ImGui::SameLine(ImGui::GetWindowContentRegionMax().x - 2.0f * ImGui::GetFrameHeight() -
                    ImGui::GetStyle().ItemInnerSpacing.x);
    const int shown = studio.shown_look;
    if (ImGui::Button("+", {ImGui::GetFrameHeight(), 0.0f})) commit(studio, DuplicateLook{shown});
    name_last_item("duplicate-look-button");
    tooltip(
        "A new look, starting as a copy of the shown one (Ctrl+D). N starts with an empty one.");
    ImGui::SameLine(0.0f, ImGui::GetStyle().ItemInnerSpacing.x);
    const bool only_one = studio.session.document().looks.size() < 2;
    begin_disabled(only_one);
    if (ImGui::Button("−", {ImGui::GetFrameHeight(), 0.0f})) commit(studio, DeleteLook{shown});
    end_disabled();
    name_last_item("delete-look-button");
    tooltip(only_one ? "The last look cannot be deleted."
                     : "Delete the shown look (Del). Ctrl+Z brings it back.");
    // A copy: a row may change the list.
    const auto looks = studio.session.document().looks;
    for (std::size_t i = 0; i < looks.size(); ++i) {
        draw_row(studio, looks[i], static_cast<int>(i), static_cast<int>(looks.size()));
    }
}

}  // namespace livery
