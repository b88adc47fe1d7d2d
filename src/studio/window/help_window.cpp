// The list of keys, and what the program is.
#include <imgui.h>

#include "studio/kit/theme.h"
#include "studio/window/actions.h"
#include "studio/window/shell.h"

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

}  // namespace

void draw_help(Shell& shell) {
    if (shell.help_open) {
        begin_dialog("Keys", shell.help_open);
        draw_keys();
        ImGui::Dummy({0.0f, em(0.4f)});
        ImGui::TextColored(
            colours::dim_text,
            "%s",
            "Hovering over a paint shows it on the mock-up, a click keeps it, Esc takes it back.\n"
            "Artwork: Place it by a click lets it follow the pointer, a click leaves it, Esc takes "
            "it back.\n"
            "Tab and Shift+Tab go from one button, list or field to the next; the arrow keys move "
            "inside lists and among neighbours.\n"
            "While looks are presented: arrow right or Page Down goes on, arrow left or Page Up "
            "goes back, the space bar pauses,\n"
            "R shows the look anew, B or the full stop shows grey; black is Ctrl+B then. A "
            "presenter's remote sends these keys.\n"
            "Enter presses, opens a list, or types into a slider; Esc closes. On the swatches the "
            "arrow keys try the neighbours, Enter paints.");
        ImGui::End();
    }
    if (shell.about_open) {
        begin_dialog("About Livery", shell.about_open);
        ImGui::TextUnformatted("Livery " LIVERY_VERSION);
        ImGui::Dummy({em(24.0f), em(0.2f)});
        dim_text(
            "Throws paint that does not exist yet onto a grey model of a product, so that people "
            "can "
            "judge it before anyone mixes a can.");
        ImGui::Dummy({0.0f, em(0.2f)});
        dim_text(shell.drawn_with);
        ImGui::Dummy({0.0f, em(0.2f)});
        dim_text(
            "The libraries and data that it stands on, with their licences, are listed in "
            "docs/third-party.md.");
        ImGui::End();
    }
}

}  // namespace livery
