// Menu bar, three columns with lines between that can be dragged, and two bars below.
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <imgui.h>

#include "studio/ballot_panel.h"
#include "studio/calibration_panel.h"
#include "studio/capture/capture_panel.h"
#include "studio/kit/theme.h"
#include "studio/nudge/nudge_panel.h"
#include "studio/paint/library_panel.h"
#include "studio/paint/swatches.h"
#include "studio/presenting/presenting.h"
#include "studio/product/open_session.h"
#include "studio/seats/seats_panel.h"
#include "studio/window/actions.h"
#include "studio/window/shell.h"

namespace livery {

namespace {

/// Its first key, or its second with Ctrl where plain letters mean something else now.
std::string key_in_menu(const Action& action, const Shell& shell) {
    if (action.chords.empty()) return "";
    const bool letters = is_presenting(shell.studio) || ballot_letters(shell.studio) > 0;
    const bool other =
        letters && action.chords.size() > 1 && !action.chords[0].ctrl && action.chords[1].ctrl;
    return text_of(action.chords[other ? 1 : 0]);
}

void draw_menu_entry(const Action& action, Shell& shell) {
    if (action.starts_group) ImGui::Separator();
    std::string label = action.label;
    if (action.detail) {
        if (const std::string detail = action.detail(shell); !detail.empty())
            label += ": " + detail;
    }
    const std::string keys = key_in_menu(action, shell);
    const bool checked = action.checked && action.checked(shell);
    if (ImGui::MenuItem(label.c_str(), keys.c_str(), checked, is_enabled(action, shell))) {
        run_action(action, shell);
    }
    name_last_item("menu:" + action.id);
}

/// Those that are gone stay in the list, in grey: a memory stick may come back.
void draw_recent_sessions(Shell& shell) {
    const auto files = recent_sessions(shell.studio.settings);
    const bool open = ImGui::BeginMenu("Recent", !files.empty());
    name_last_item("menu:recent");
    if (!open) return;
    const auto shown = shell.studio.session.file();
    for (std::size_t k = 0; k < files.size(); ++k) {
        std::error_code error;
        const bool there = std::filesystem::is_regular_file(files[k], error);
        const std::string label = files[k].stem().string() + "##" + std::to_string(k);
        const std::string where =
            there ? files[k].parent_path().filename().string() : std::string("not there");
        if (ImGui::MenuItem(label.c_str(), where.c_str(), shown == files[k], there)) {
            open_other_session(shell, files[k]);
        }
        name_last_item("recent:" + files[k].stem().string());
        tooltip(files[k].string());
    }
    ImGui::EndMenu();
}

/// A region of the window that scrolls on its own.
void begin_region(const char* name, ImVec2 size, bool raised = true, ImGuiWindowFlags flags = 0) {
    ImGui::PushStyleColor(ImGuiCol_ChildBg,
                          raised ? colours::panel : ImVec4(0.085f, 0.085f, 0.085f, 1.0f));
    ImGui::BeginChild(name, size, false, flags | ImGuiWindowFlags_AlwaysUseWindowPadding);
    ImGui::PopStyleColor();
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

void draw_left_column(Shell& shell) {
    draw_looks_panel(shell.studio);
    ImGui::Dummy({0.0f, em(0.4f)});
    draw_parts_panel(shell.studio);
}

void draw_right_column(Shell& shell) {
    struct Tab {
        const char* label;
        void (*draw)(Studio&);
    };
    static constexpr std::array<Tab, kTabs> tabs = {{{"Paints", draw_library_panel},
                                                     {"Paint", draw_paint_panel},
                                                     {"Artwork", draw_artwork_panel},
                                                     {"Light", draw_lighting_panel},
                                                     {"Calibrate", draw_calibration_panel},
                                                     {"Frame", draw_plan_panel}}};
    take_swatches(shell.studio);
    if (std::exchange(shell.studio.panels.calibration->capture_wanted, false))
        show_capture(shell, true);
    if (std::exchange(shell.studio.panels.calibration->nudge_wanted, false))
        show_nudge(shell, true);
    if (shell.capture_open) {
        shell.studio.panels.library->owns_arrows = false;
        return draw_capture_panel(shell);
    }
    if (shell.nudge_open) {
        shell.studio.panels.library->owns_arrows = false;
        return draw_nudge_panel(shell);
    }
    if (std::exchange(shell.studio.panels.seats->wanted, false)) show_seats(shell, true);
    if (shell.seats_open && !is_presenting(shell.studio)) {
        shell.studio.panels.library->owns_arrows = false;
        return draw_seats_panel(shell.studio, shell.seats_open);
    }
    if (shell.ballots_open) {
        shell.studio.panels.library->owns_arrows = false;
        return draw_ballot_panel(shell.studio, shell.ballots_open);
    }
    shell.studio.panels.ballot->was_open = false;
    if (!ImGui::BeginTabBar("tabs", ImGuiTabBarFlags_FittingPolicyResizeDown)) return;
    for (std::size_t i = 0; i < tabs.size(); ++i) {
        const bool to_open = shell.tab_to_open == static_cast<int>(i);
        const bool open = ImGui::BeginTabItem(
            tabs[i].label, nullptr, to_open ? ImGuiTabItemFlags_SetSelected : 0);
        name_last_item(std::string("tab:") + tabs[i].label);
        if (!open) {
            if (tabs[i].draw == draw_library_panel) {
                shell.studio.panels.library->owns_arrows = false;
            }
            continue;
        }
        shell.open_tab = static_cast<int>(i);
        ImGui::BeginChild(tabs[i].label);
        tabs[i].draw(shell.studio);
        ImGui::EndChild();
        ImGui::EndTabItem();
    }
    shell.tab_to_open.reset();
    ImGui::EndTabBar();
}

/// Regions touch; what is inside them does not.
template <typename Draw>
void with_spacing(ImVec2 spacing, Draw draw) {
    ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, spacing);
    draw();
    ImGui::PopStyleVar();
}

void draw_columns(Shell& shell, float height, ImVec2 spacing) {
    const float width = ImGui::GetContentRegionAvail().x, unit = em(1.0f);
    const float splitters = 2.0f * std::max(3.0f, em(0.3f));
    // The picture keeps at least a third, however narrow the window.
    const float share = 0.66f * width / unit;
    const float squeeze = std::min(1.0f, share / (shell.left_width_em + shell.right_width_em));
    const float left = std::floor(shell.left_width_em * squeeze * unit);
    const float right = std::floor(shell.right_width_em * squeeze * unit);
    begin_region("left", {left, height});
    with_spacing(spacing, [&] { draw_left_column(shell); });
    ImGui::EndChild();
    draw_splitter("left-splitter", shell.left_width_em, 1.0f, 11.0f, 30.0f, height);
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {em(0.45f), em(0.45f)});
    begin_region("middle",
                 {width - left - right - splitters, height},
                 false,
                 ImGuiWindowFlags_NoScrollWithMouse | ImGuiWindowFlags_NoScrollbar);
    ImGui::PopStyleVar();
    with_spacing(spacing, [&] {
        if (is_presenting(shell.studio)) {
            draw_vote_stage(shell);
        } else if (shell.capture_open) {
            draw_capture_stage(shell);
        } else {
            draw_stage(shell);
        }
    });
    ImGui::EndChild();
    draw_splitter("right-splitter", shell.right_width_em, -1.0f, 17.0f, 40.0f, height);
    begin_region("right", {right, height});
    with_spacing(spacing, [&] { draw_right_column(shell); });
    ImGui::EndChild();
}

}  // namespace

void draw_menu_bar(Shell& shell) {
    if (!ImGui::BeginMenuBar()) return;
    for (const char* menu : {"File", "Edit", "View", "Look", "Projector", "Help"}) {
        const bool open = ImGui::BeginMenu(menu);
        name_last_item(std::string("menu:") + menu);
        if (!open) continue;
        for (const Action& action : all_actions()) {
            if (action.menu != menu) continue;
            draw_menu_entry(action, shell);
            if (action.id == "open-session") draw_recent_sessions(shell);
        }
        ImGui::EndMenu();
    }
    if (shell.studio.session.save_problem()) {
        const char* text = "NOT SAVED";
        ImGui::SameLine(ImGui::GetWindowWidth() - ImGui::CalcTextSize(text).x - em(1.0f));
        ImGui::TextColored(colours::error, "%s", text);
        tooltip(*shell.studio.session.save_problem());
    }
    ImGui::EndMenuBar();
}

void draw_layout(Shell& shell) {
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
    draw_menu_bar(shell);
    const ImVec2 spacing = ImGui::GetStyle().ItemSpacing;
    ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {0.0f, 0.0f});
    const float gap = std::max(2.0f, em(0.18f));
    const float bar = em(3.5f), status = em(1.75f);
    if (has_vote_bar(shell)) {
        ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0.0f, 0.0f});
        begin_region("vote-bar", {0.0f, em(4.0f)}, true, ImGuiWindowFlags_NoScrollbar);
        ImGui::PopStyleVar();
        with_spacing(spacing, [&] { draw_vote_bar(shell); });
        ImGui::EndChild();
    }
    const float columns = ImGui::GetContentRegionAvail().y - bar - status - gap;
    draw_columns(shell, columns, spacing);
    ImGui::Dummy({0.0f, gap});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {em(0.7f), em(0.4f)});
    begin_region("bar", {0.0f, bar}, true, ImGuiWindowFlags_NoScrollbar);
    ImGui::PopStyleVar();
    with_spacing(spacing, [&] { draw_projector_bar(shell); });
    ImGui::EndChild();
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {em(0.7f), em(0.25f)});
    begin_region("status", {0.0f, status}, false, ImGuiWindowFlags_NoScrollbar);
    ImGui::PopStyleVar();
    with_spacing(spacing, [&] { draw_status_line(shell); });
    ImGui::EndChild();
    ImGui::PopStyleVar();
    ImGui::End();
}

}  // namespace livery
