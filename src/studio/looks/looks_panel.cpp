// The looks of the session: shown, renamed, moved, chosen as B.
#include <utility>

#include <GLFW/glfw3.h>
#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include "studio/looks/look_files.h"
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

// --- its keys and menu ---

const std::vector<SessionLook>& looks_of(const Studio& studio) {
    return studio.session.document().looks;
}
bool has_several_looks(const Studio& studio) { return looks_of(studio).size() > 1; }
bool has_compared_look(const Studio& studio) { return studio.compared_look.has_value(); }
bool is_not_first(const Studio& studio) { return studio.shown_place > 0; }
bool is_not_last(const Studio& studio) { return studio.shown_place + 1 < looks_of(studio).size(); }
bool is_wiping(const Studio& studio) { return studio.wiping; }

void show_look_at(Studio& studio, std::size_t place) {
    if (place >= looks_of(studio).size()) return;
    stop_trying(studio);
    show_look(studio, looks_of(studio)[place].id);
}

template <int step>
void step_look(Studio& studio) {
    const auto count = static_cast<int>(looks_of(studio).size());
    const auto place = static_cast<int>(studio.shown_place) + step;
    show_look_at(studio, static_cast<std::size_t>((place + count) % count));
}

template <int step>
void move_look(Studio& studio) {
    commit(studio, MoveLook{studio.shown_look, static_cast<int>(studio.shown_place) + step});
}

void add_look(Studio& studio) {
    Look look = find_look(studio.session.document(), studio.shown_look)->look;
    look.name = "new look";
    look.parts.clear();
    commit(studio, AddLook{look, -1});
}

void delete_look(Studio& studio) {
    stop_trying(studio);
    commit(studio, DeleteLook{studio.shown_look});
}

void duplicate_look(Studio& studio) { commit(studio, DuplicateLook{studio.shown_look}); }
void rename_look(Studio& studio) { studio.renaming_look = studio.shown_look; }
void share_lighting(Studio& studio) { commit(studio, ShareLighting{studio.shown_look}); }
void wipe(Studio& studio) { studio.wiping = !studio.wiping; }

std::vector<Action> look_actions() {
    const KeyChord down = key(GLFW_KEY_PAGE_DOWN), up = key(GLFW_KEY_PAGE_UP);
    const KeyChord right = key(GLFW_KEY_RIGHT), left = key(GLFW_KEY_LEFT);
    std::vector<Action> list{
        line_above({"import-look", "File", "Import look…", {ctrl(GLFW_KEY_I)}, ask_for_look_file}),
        {"export-look", "File", "Export look…", {ctrl(GLFW_KEY_E)}, ask_where_to_export_look},
        {"export-product", "File", "Export product with looks…", {}, ask_where_to_export_product},
        line_above({"save-session-as",
                    "File",
                    "Save session as…",
                    {ctrl_shift(GLFW_KEY_S)},
                    ask_where_to_save_session}),
        line_above({"save-picture",
                    "File",
                    "Save picture…",
                    {ctrl(GLFW_KEY_S)},
                    ask_where_to_save_picture}),
        {"new-look", "Look", "New", {key(GLFW_KEY_N)}, add_look},
        {"duplicate-look", "Look", "Duplicate", {ctrl(GLFW_KEY_D)}, duplicate_look},
        {"rename-look", "Look", "Rename", {key(GLFW_KEY_F2)}, rename_look},
        {"delete-look", "Look", "Delete", {key(GLFW_KEY_DELETE)}, delete_look, has_several_looks},
        line_above(
            {"move-look-up", "Look", "Move up", {ctrl(GLFW_KEY_UP)}, move_look<-1>, is_not_first}),
        {"move-look-down", "Look", "Move down", {ctrl(GLFW_KEY_DOWN)}, move_look<1>, is_not_last},
        {"share-lighting",
         "Look",
         "Light all looks like this one",
         {},
         share_lighting,
         has_several_looks},
        repeating(line_above(
            {"next-look", "Look", "Next", {down, right}, step_look<1>, has_several_looks})),
        repeating(
            {"previous-look", "Look", "Previous", {up, left}, step_look<-1>, has_several_looks}),
        line_above({"wipe",
                    "Look",
                    "Wipe between A and B",
                    {key(GLFW_KEY_W)},
                    wipe,
                    has_compared_look,
                    is_wiping})};
    Action hold_b{"hold-b",
                  "",
                  "Show B while held",
                  {key(GLFW_KEY_SPACE), key(GLFW_KEY_GRAVE_ACCENT)},
                  [](Studio& s) { s.showing_b = true; },
                  has_compared_look};
    hold_b.released = [](Studio& s) { s.showing_b = false; };
    list.push_back(std::move(hold_b));
    for (int n = 1; n <= 9; ++n) {
        const auto place = static_cast<std::size_t>(n - 1);
        list.push_back({fmt::format("look-{}", n),
                        "",
                        fmt::format("Show look {}", n),
                        {key(GLFW_KEY_0 + n), key(GLFW_KEY_KP_0 + n)},
                        [place](Studio& s) { show_look_at(s, place); },
                        [place](const Studio& s) { return place < looks_of(s).size(); }});
    }
    return list;
}

bool stop_renaming(Studio& studio) { return std::exchange(studio.renaming_look, {}).has_value(); }

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

Panel looks_panel() {
    return {.name = "looks",
            .place = PanelPlace::left,
            .draw = draw_looks_panel,
            .give_up = stop_renaming,
            .actions = look_actions};
}

}  // namespace livery
