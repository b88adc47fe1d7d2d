#include "studio/window/layout.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <GLFW/glfw3.h>
#include <fmt/format.h>
#include <imgui.h>

#include "studio/presenting/presenting.h"
#include "studio/product/new_session.h"
#include "studio/studio.h"

namespace livery {

namespace {

/// Its first key, or its second with Ctrl where plain letters mean something else now.
std::string key_in_menu(const Action& action, const Studio& studio) {
    if (action.chords.empty()) return "";
    const bool letters = is_editing_locked(studio) || letters_taken(studio) > 0;
    const bool other =
        letters && action.chords.size() > 1 && !action.chords[0].ctrl && action.chords[1].ctrl;
    return text_of(action.chords[other ? 1 : 0]);
}

void draw_menu_entry(const Action& action, Studio& studio) {
    if (action.starts_group) ImGui::Separator();
    std::string label = action.label;
    if (action.detail) {
        if (const std::string detail = action.detail(studio); !detail.empty())
            label += ": " + detail;
    }
    const std::string keys = key_in_menu(action, studio);
    const bool checked = action.checked && action.checked(studio);
    if (ImGui::MenuItem(label.c_str(), keys.c_str(), checked, is_enabled(action, studio))) {
        run_action(action, studio);
    }
    name_last_item("menu:" + action.id);
}

/// Those that are gone stay in the list, in grey: a memory stick may come back.
void draw_recent_sessions(Studio& studio) {
    const auto files = recent_sessions(studio.settings);
    const bool open = named(ImGui::BeginMenu("Recent", !files.empty()), "menu:recent");
    if (!open) return;
    const auto shown = studio.session.file();
    for (std::size_t k = 0; k < files.size(); ++k) {
        std::error_code error;
        const bool there = std::filesystem::is_regular_file(files[k], error);
        const std::string label = files[k].stem().string() + "##" + std::to_string(k);
        const std::string where =
            there ? files[k].parent_path().filename().string() : std::string("not there");
        if (ImGui::MenuItem(label.c_str(), where.c_str(), shown == files[k], there)) {
            open_other_session(studio, files[k]);
        }
        name_last_item("recent:" + files[k].stem().string());
        tooltip(files[k].string());
    }
    ImGui::EndMenu();
}

/// A region of the window that scrolls on its own. Regions touch; what is inside them does not.
struct Region {
    const char* name;
    ImVec2 size, padding, spacing;
    bool raised = true;
    ImGuiWindowFlags flags = ImGuiWindowFlags_NoScrollbar;
};

template <typename Draw>
void draw_region(const Region& region, const Draw& draw) {
    ImGui::PushStyleColor(ImGuiCol_ChildBg,
                          region.raised ? colours::panel : ImVec4(0.085f, 0.085f, 0.085f, 1.0f));
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, region.padding);
    ImGui::BeginChild(
        region.name, region.size, false, region.flags | ImGuiWindowFlags_AlwaysUseWindowPadding);
    ImGui::PopStyleVar();
    ImGui::PopStyleColor();
    ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, region.spacing);
    draw();
    ImGui::PopStyleVar();
    ImGui::EndChild();
}

/// Changes a column's width by dragging; `direction` is 1 when the column is left of it.
void draw_splitter(
    const char* name, float& width_em, float direction, float low, float high, float height) {
    ImGui::SameLine(0.0f, 0.0f);
    const float thickness = std::max(3.0f, em(0.3f));
    ImGui::InvisibleButton(name, {thickness, height});
    if (ImGui::IsItemHovered() || ImGui::IsItemActive()) {
        ImGui::SetMouseCursor(ImGuiMouseCursor_ResizeEW);
        ImGui::GetWindowDrawList()->AddRectFilled(
            ImGui::GetItemRectMin(), ImGui::GetItemRectMax(), ImGui::GetColorU32(colours::line));
    }
    if (ImGui::IsItemActive()) {
        width_em =
            std::clamp(width_em + direction * ImGui::GetIO().MouseDelta.x / em(1.0f), low, high);
    }
    ImGui::SameLine(0.0f, 0.0f);
}

void draw_left_column(Studio& studio) {
    bool first = true;
    for (const Panel& panel : all_panels()) {
        if (panel.place != PanelPlace::left) continue;
        if (!std::exchange(first, false)) ImGui::Dummy({0.0f, em(0.4f)});
        panel.draw(studio);
    }
}

void draw_right_column(Studio& studio) {
    for (const Panel& panel : all_panels()) {
        if (panel.place == PanelPlace::column && panel.is_open(studio)) return panel.draw(studio);
    }
    if (!ImGui::BeginTabBar("tabs", ImGuiTabBarFlags_FittingPolicyResizeDown)) return;
    for (const Panel& panel : all_panels()) {
        if (panel.place != PanelPlace::tab) continue;
        const bool open = ImGui::BeginTabItem(
            panel.name,
            nullptr,
            studio.tab_to_open == panel.name ? ImGuiTabItemFlags_SetSelected : 0);
        name_last_item(std::string("tab:") + panel.name);
        if (!open) continue;
        studio.open_tab = panel.name;
        ImGui::BeginChild(panel.name);
        panel.draw(studio);
        ImGui::EndChild();
        ImGui::EndTabItem();
    }
    studio.tab_to_open.clear();
    ImGui::EndTabBar();
}

void draw_middle_column(Studio& studio) {
    for (const Panel& panel : all_panels()) {
        if (panel.draw_stage && panel.draw_stage(studio)) return;
    }
}

void draw_columns(Studio& studio, float height, ImVec2 spacing) {
    const float width = ImGui::GetContentRegionAvail().x, unit = em(1.0f);
    const float splitters = 2.0f * std::max(3.0f, em(0.3f));
    // The picture keeps at least a third, however narrow the window.
    const float share = 0.66f * width / unit;
    const float squeeze = std::min(1.0f, share / (studio.left_width_em + studio.right_width_em));
    const float left = std::floor(studio.left_width_em * squeeze * unit);
    const float right = std::floor(studio.right_width_em * squeeze * unit);
    const ImVec2 padding = ImGui::GetStyle().WindowPadding;
    draw_region({"left", {left, height}, padding, spacing, true, 0},
                [&] { draw_left_column(studio); });
    draw_splitter("left-splitter", studio.left_width_em, 1.0f, 11.0f, 30.0f, height);
    draw_region({"middle",
                 {width - left - right - splitters, height},
                 {em(0.45f), em(0.45f)},
                 spacing,
                 false,
                 ImGuiWindowFlags_NoScrollWithMouse | ImGuiWindowFlags_NoScrollbar},
                [&] { draw_middle_column(studio); });
    draw_splitter("right-splitter", studio.right_width_em, -1.0f, 17.0f, 40.0f, height);
    draw_region({"right", {right, height}, padding, spacing, true, 0},
                [&] { draw_right_column(studio); });
}

}  // namespace

void draw_menu_bar(Studio& studio) {
    if (!ImGui::BeginMenuBar()) return;
    for (const char* menu : {"File", "Edit", "View", "Look", "Projector", "Help"}) {
        const bool open = named(ImGui::BeginMenu(menu), std::string("menu:") + menu);
        if (!open) continue;
        for (const Action& action : all_actions()) {
            if (action.menu != menu) continue;
            draw_menu_entry(action, studio);
            if (action.id == "open-session") draw_recent_sessions(studio);
        }
        ImGui::EndMenu();
    }
    if (studio.session.save_problem()) {
        const char* text = "NOT SAVED";
        ImGui::SameLine(ImGui::GetWindowWidth() - ImGui::CalcTextSize(text).x - em(1.0f));
        ImGui::TextColored(colours::error, "%s", text);
        tooltip(*studio.session.save_problem());
    }
    ImGui::EndMenuBar();
}

void draw_layout(Studio& studio) {
    const ImGuiViewport& viewport = *ImGui::GetMainViewport();
    ImGui::SetNextWindowPos(viewport.Pos);
    ImGui::SetNextWindowSize(viewport.Size);
    ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, 0.0f);
    ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, 0.0f);
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0.0f, 0.0f});
    ImGui::PushStyleColor(ImGuiCol_WindowBg, {0.065f, 0.065f, 0.065f, 1.0f});
    ImGui::Begin("Livery",
                 nullptr,
                 ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_MenuBar |
                     ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                     ImGuiWindowFlags_NoBringToFrontOnFocus | ImGuiWindowFlags_NoScrollWithMouse);
    ImGui::PopStyleColor();
    ImGui::PopStyleVar(3);
    draw_menu_bar(studio);
    const ImVec2 spacing = ImGui::GetStyle().ItemSpacing;
    ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {0.0f, 0.0f});
    const float gap = std::max(2.0f, em(0.18f));
    const float bar = em(3.5f), status = em(1.75f);
    if (has_vote_bar(studio)) {
        draw_region({"vote-bar", {0.0f, em(4.0f)}, {0.0f, 0.0f}, spacing},
                    [&] { draw_vote_bar(studio); });
    }
    const float columns = ImGui::GetContentRegionAvail().y - bar - status - gap;
    draw_columns(studio, columns, spacing);
    ImGui::Dummy({0.0f, gap});
    draw_region({"bar", {0.0f, bar}, {em(0.7f), em(0.4f)}, spacing},
                [&] { draw_projector_bar(studio); });
    draw_region({"status", {0.0f, status}, {em(0.7f), em(0.25f)}, spacing, false},
                [&] { draw_status_line(studio); });
    ImGui::PopStyleVar();
    ImGui::End();
}

namespace {

std::vector<std::string> tabs() {
    std::vector<std::string> names;
    for (const Panel& panel : all_panels()) {
        if (panel.place == PanelPlace::tab) names.emplace_back(panel.name);
    }
    return names;
}

int place_of_open_tab(const Studio& studio) {
    const auto names = tabs();
    const auto found = std::find(names.begin(), names.end(), studio.open_tab);
    return found == names.end() ? 0 : static_cast<int>(found - names.begin());
}

template <int step>
void turn_tabs(Studio& studio) {
    const auto names = tabs();
    const int count = static_cast<int>(names.size());
    studio.tab_to_open =
        names[static_cast<std::size_t>((place_of_open_tab(studio) + step + count) % count)];
}

std::vector<Action> tab_actions() {
    return {repeating(line_above({"next-tab",
                                  "View",
                                  "Next tab",
                                  {ctrl(GLFW_KEY_TAB), ctrl(GLFW_KEY_PAGE_DOWN)},
                                  turn_tabs<1>})),
            repeating({"previous-tab",
                       "View",
                       "Previous tab",
                       {ctrl_shift(GLFW_KEY_TAB), ctrl(GLFW_KEY_PAGE_UP)},
                       turn_tabs<-1>})};
}

void describe_tabs(const Studio& studio, MapState& state) {
    state["open_tab"] = std::to_string(place_of_open_tab(studio));
}

}  // namespace

Panel tabs_panel() { return {.name = "tabs", .describe = describe_tabs, .actions = tab_actions}; }

namespace {

const ImVec4& colour_of(Notice::Level level) {
    using enum Notice::Level;
    return level == error ? colours::error : level == warning ? colours::warning : colours::text;
}

/// True when it was dismissed.
bool draw_notice(const Notice& notice, float width) {
    const ImVec2 from = ImGui::GetCursorScreenPos();
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.ChannelsSplit(2);
    list.ChannelsSetCurrent(1);
    ImGui::BeginGroup();
    ImGui::Dummy({width, em(0.2f)});
    ImGui::Indent(em(0.9f));
    const float button = ImGui::GetFrameHeight();
    ImGui::PushTextWrapPos(ImGui::GetCursorPosX() + width - em(1.8f) - button);
    ImGui::PushStyleColor(ImGuiCol_Text, colour_of(notice.level));
    ImGui::TextUnformatted(notice.what.c_str());
    ImGui::PopStyleColor();
    for (const std::string& text : {notice.cause, notice.fix}) {
        if (text.empty()) continue;
        ImGui::PushStyleColor(ImGuiCol_Text, colours::dim_text);
        ImGui::TextUnformatted(text.c_str());
        ImGui::PopStyleColor();
    }
    ImGui::PopTextWrapPos();
    ImGui::Unindent(em(0.9f));
    ImGui::Dummy({width, em(0.2f)});
    ImGui::EndGroup();
    const ImVec2 low = from, high = ImGui::GetItemRectMax();
    const ImVec2 after = ImGui::GetCursorScreenPos();
    ImGui::SetCursorScreenPos({low.x + width - button - em(0.2f), low.y + em(0.2f)});
    ImGui::PushStyleColor(ImGuiCol_Button, {0, 0, 0, 0});
    const bool dismissed = ImGui::Button("×", {button, button});
    ImGui::PopStyleColor();
    name_last_item("dismiss-notice");
    ImGui::SetCursorScreenPos(after);
    list.ChannelsSetCurrent(0);
    list.AddRectFilled(low, {low.x + width, high.y}, IM_COL32(46, 46, 46, 245), em(0.3f));
    list.AddRectFilled(
        low, {low.x + em(0.25f), high.y}, ImGui::GetColorU32(colour_of(notice.level)), em(0.15f));
    list.ChannelsMerge();
    return dismissed;
}

}  // namespace

void draw_notices(Studio& studio) {
    auto& notices = studio.notices;
    std::erase_if(notices, [&](const Notice& n) {
        return n.shown_until_s > 0.0 && n.shown_until_s <= studio.now_s;
    });
    if (notices.empty()) return;
    const float width = em(25.0f);
    ImGui::SetNextWindowPos({studio.stage_x + em(0.7f), studio.stage_y + em(0.7f)});
    ImGui::SetNextWindowBgAlpha(0.0f);
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0.0f, 0.0f});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, 0.0f);
    ImGui::Begin("##notices",
                 nullptr,
                 ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_AlwaysAutoResize |
                     ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoFocusOnAppearing |
                     ImGuiWindowFlags_NoNav | ImGuiWindowFlags_NoMove);
    std::size_t dismissed = notices.size();
    constexpr std::size_t most_shown = 4;
    const std::size_t first = notices.size() > most_shown ? notices.size() - most_shown : 0;
    for (std::size_t i = first; i < notices.size(); ++i) {
        // Over a camera's live view news can wait
        if (is_open(studio, "capture") && notices[i].level == Notice::Level::info) continue;
        ImGui::PushID(static_cast<int>(i));
        if (draw_notice(notices[i], width)) dismissed = i;
        ImGui::PopID();
    }
    if (dismissed < notices.size())
        notices.erase(notices.begin() + static_cast<std::ptrdiff_t>(dismissed));
    ImGui::End();
    ImGui::PopStyleVar(2);
}

}  // namespace livery
