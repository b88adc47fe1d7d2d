// The list of keys, the scale, and what the program is.
#include <algorithm>

#include <GLFW/glfw3.h>
#include <fmt/format.h>
#include <imgui.h>

#include "studio/studio.h"

namespace livery {

namespace {

void draw_key_row(const std::string& keys, const std::string& what) {
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    ImGui::TextColored(colours::dim_text, "%s", keys.c_str());
    ImGui::TableNextColumn();
    ImGui::TextUnformatted(what.c_str());
}

std::string keys_of(const Action& action) {
    std::string keys;
    // Two suffice: the others are the same keys elsewhere on the keyboard.
    for (std::size_t i = 0; i < action.chords.size() && i < 2; ++i) {
        keys += (keys.empty() ? "" : "  or  ") + text_of(action.chords[i]);
    }
    return keys;
}

void draw_keys() {
    if (!ImGui::BeginTable("keys", 4, ImGuiTableFlags_SizingFixedFit | ImGuiTableFlags_PadOuterX))
        return;
    std::vector<std::pair<std::string, std::string>> rows;
    rows.emplace_back("1 … 9", "Show a look by its number");
    for (const Action& action : all_actions()) {
        const bool one_of_nine = action.id.starts_with("look-");
        if (action.chords.empty() || one_of_nine) continue;
        const std::string menu =
            action.menu.empty() || action.menu == "View" ? "" : action.menu + ": ";
        const std::string keys = action.id == "black" || action.id == "freeze"
                                     ? keys_of(action)
                                     : text_of(action.chords.front());
        rows.emplace_back(keys, menu + action.label);
    }
    const std::size_t half = (rows.size() + 1) / 2;
    for (std::size_t i = 0; i < half; ++i) {
        draw_key_row(rows[i].first, rows[i].second + "      ");
        if (half + i >= rows.size()) continue;
        ImGui::TableNextColumn();
        ImGui::TextColored(colours::dim_text, "%s", rows[half + i].first.c_str());
        ImGui::TableNextColumn();
        ImGui::TextUnformatted(rows[half + i].second.c_str());
    }
    ImGui::EndTable();
}

void begin_dialog(const char* title, bool& open) {
    ImGui::SetNextWindowPos(ImGui::GetMainViewport()->GetCenter(), ImGuiCond_Always, {0.5f, 0.5f});
    ImGui::Begin(title,
                 &open,
                 ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_AlwaysAutoResize |
                     ImGuiWindowFlags_NoSavedSettings);
}

/// Which of them is open.
struct HelpState {
    bool keys = false, about = false;
};

void draw_keys_page(Studio& studio) {
    bool& open = studio.panels.of<HelpState>().keys;
    if (!open) return;
    begin_dialog("Keys", open);
    draw_keys();
    ImGui::Dummy({0.0f, em(0.4f)});
    ImGui::TextColored(
        colours::dim_text,
        "%s",
        "Hovering over a paint shows it on the mock-up, a click keeps it, Esc takes it back.\n"
        "Artwork: Place it by a click lets it follow the pointer, a click leaves it, Esc takes it "
        "back.\n"
        "Tab and Shift+Tab go from one button, list or field to the next; the arrow keys move "
        "inside lists and among neighbours.\n"
        "While looks are presented: arrow right or Page Down goes on, arrow left or Page Up goes "
        "back, the space bar pauses,\n"
        "R shows the look anew, B or the full stop shows grey; black is Ctrl+B then. A presenter's "
        "remote sends these keys.\n"
        "Enter presses, opens a list, or types into a slider; Esc closes. On the swatches the "
        "arrow "
        "keys try the neighbours, Enter paints.");
    ImGui::End();
}

void draw_about_page(Studio& studio) {
    bool& open = studio.panels.of<HelpState>().about;
    if (!open) return;
    begin_dialog("About Livery", open);
    ImGui::TextUnformatted("Livery " LIVERY_VERSION);
    ImGui::Dummy({em(24.0f), em(0.2f)});
    dim_text(
        "Throws paint that does not exist yet onto a grey model of a product, so that people can "
        "judge it before anyone mixes a can.");
    ImGui::Dummy({0.0f, em(0.2f)});
    dim_text(studio.drawn_with);
    ImGui::Dummy({0.0f, em(0.2f)});
    dim_text(
        "The libraries and data that it stands on, with their licences, are listed in "
        "docs/third-party.md.");
    ImGui::End();
}

void use_scale(Studio& studio, double scale) {
    studio.user_scale = std::clamp(scale, 0.75, 3.0);
    studio.session.set_workspace("scale", fmt::format("{:.2f}", studio.user_scale));
}

std::vector<Action> keys_actions() {
    return {repeating(line_above(
                {"larger",
                 "View",
                 "Larger",
                 {ctrl(GLFW_KEY_EQUAL), ctrl_shift(GLFW_KEY_EQUAL), ctrl(GLFW_KEY_KP_ADD)},
                 [](Studio& s) { use_scale(s, s.user_scale * 1.1); }})),
            repeating({"smaller",
                       "View",
                       "Smaller",
                       {ctrl(GLFW_KEY_MINUS), ctrl(GLFW_KEY_KP_SUBTRACT)},
                       [](Studio& s) { use_scale(s, s.user_scale / 1.1); }}),
            {"usual-size",
             "View",
             "Usual size",
             {ctrl(GLFW_KEY_0), ctrl(GLFW_KEY_KP_0)},
             [](Studio& s) { use_scale(s, 1.0); }},
            {"shortcuts",
             "Help",
             "Keys",
             {key(GLFW_KEY_F1), {GLFW_KEY_SLASH, false, true}},
             [](Studio& s) { show_panel(s, "keys", !is_open(s, "keys")); }}};
}

std::vector<Action> program_actions() {
    return {line_above(in_dialogs(
                {"quit", "File", "Quit", {ctrl(GLFW_KEY_Q)}, [](Studio& s) { s.quit = true; }})),
            {"about", "Help", "About Livery", {}, [](Studio& s) { show_panel(s, "about"); }}};
}

}  // namespace

Panel keys_panel() {
    return {.name = "keys",
            .place = PanelPlace::page,
            .draw = draw_keys_page,
            .is_open = [](const Studio& s) { return s.panels.of<HelpState>().keys; },
            .show = [](Studio& s, bool shown) { s.panels.of<HelpState>().keys = shown; },
            .esc_closes = true,
            .actions = keys_actions};
}

Panel program_panel() {
    return {.name = "about",
            .place = PanelPlace::page,
            .draw = draw_about_page,
            .is_open = [](const Studio& s) { return s.panels.of<HelpState>().about; },
            .show = [](Studio& s, bool shown) { s.panels.of<HelpState>().about = shown; },
            .esc_closes = true,
            .actions = program_actions};
}

}  // namespace livery
