// Below the picture: which monitor is the projector, its state, black and freeze.
#include <algorithm>

#include <fmt/format.h>
#include <imgui.h>

#include "studio/frame/quality_costs.h"
#include "studio/presenting/presenting.h"
#include "studio/studio.h"
#include "studio/window/layout.h"

namespace livery {

namespace {

void draw_monitor_choice(Studio& studio, float width) {
    const auto& monitors = studio.monitors;
    const auto chosen = find_monitor(monitors, studio.projector_monitor);
    const auto label = [](const Monitor& m) { return fmt::format("{}   {}", m.number, m.name); };
    const std::string shown = chosen                             ? label(*chosen)
                              : studio.projector_monitor.empty() ? "no projector"
                                                                 : "not plugged in";
    ImGui::SetNextItemWidth(width);
    // A presentation stays where its audience looks.
    const bool presented =
        is_presenting(studio) && phase_of(studio) != PresentationPhase::locked && chosen;
    begin_disabled(presented);
    const bool open = named(ImGui::BeginCombo("##projector", shown.c_str()), "projector-monitor");
    if (open) {
        if (ImGui::Selectable("no projector", studio.projector_monitor.empty())) {
            use_projector_monitor(studio, "");
        }
        name_last_item("monitor:none");
        for (const Monitor& monitor : monitors) {
            const std::string text = fmt::format("{}   {} × {}{}",
                                                 label(monitor),
                                                 monitor.width,
                                                 monitor.height,
                                                 monitor.primary ? "   (main)" : "");
            if (ImGui::Selectable(text.c_str(), monitor.id == studio.projector_monitor)) {
                use_projector_monitor(studio, monitor.id);
            }
            name_last_item(fmt::format("monitor:{}", monitor.number));
        }
        ImGui::EndCombo();
    }
    end_disabled();
    ImGui::SameLine();
    begin_disabled(is_editing_locked(studio));
    if (button("Show numbers", "show-numbers")) show_monitor_numbers(studio);
    end_disabled();
    tooltip("Shows each monitor's number, large, on every monitor for a moment.");
}

const ImVec4& colour_of(ProjectorWords::Mood mood) {
    using enum ProjectorWords::Mood;
    return mood == good      ? colours::good
           : mood == warning ? colours::warning
           : mood == error   ? colours::error
                             : colours::dim_text;
}

/// Behind the last item, cut where `right` begins; the whole is in the tooltip then.
void draw_fitted(const char* name,
                 const std::string& text,
                 const ImVec4& colour,
                 std::string help,
                 float right) {
    ImGui::SameLine(0.0f, em(1.0f));
    ImGui::AlignTextToFramePadding();
    const float room = right - em(1.0f) - ImGui::GetCursorPosX();
    const auto lines = fitted_lines(text, std::max(room, 0.0f), 1);
    if (lines.empty()) return;
    ImGui::TextColored(colour, "%s", lines.front().c_str());
    name_last_item(name);
    if (lines.front() != text) help = text + (help.empty() ? "" : "\n\n" + help);
    if (!help.empty()) tooltip(help);
}

void draw_warnings(const Studio& studio, float right) {
    if (studio.signal_warnings.empty()) return;
    const SignalWarning& worst = studio.signal_warnings.front();
    const long count = count_of_warnings(studio.signal_warnings);
    std::string all;
    for (const SignalWarning& warning : studio.signal_warnings) {
        all +=
            (all.empty() ? "" : "\n\n") + warning.what + "\n" + warning.cause + "\n" + warning.fix;
    }
    draw_fitted("signal-warnings",
                count > 1 ? fmt::format("{} ({} more)", worst.what, count - 1) : worst.what,
                colour_of(worst.severity),
                all,
                right);
}

/// A key's state that must be read from the other end of the room.
void draw_state_button(
    Studio& studio, const char* id, const char* label, bool on, float width, float height) {
    ImGui::PushFont(large_font());
    const ImVec4 lit = colours::warning;
    if (on) {
        ImGui::PushStyleColor(ImGuiCol_Button, lit);
        ImGui::PushStyleColor(ImGuiCol_ButtonHovered, lit);
        ImGui::PushStyleColor(ImGuiCol_ButtonActive, lit);
        ImGui::PushStyleColor(ImGuiCol_Text, {0.05f, 0.05f, 0.05f, 1.0f});
    }
    if (ImGui::Button(label, {width, height})) run_action(action_named(id), studio);
    if (on) ImGui::PopStyleColor(4);
    ImGui::PopFont();
    name_last_item(id);
}

}  // namespace

void draw_projector_bar(Studio& studio) {
    const float width = em(8.5f), height = ImGui::GetContentRegionAvail().y;
    const float right = ImGui::GetWindowContentRegionMax().x;
    const float top = ImGui::GetCursorPosY();
    ImGui::SetCursorPosY(top + 0.5f * (height - ImGui::GetFrameHeight()));
    ImGui::AlignTextToFramePadding();
    heading("Projector");
    ImGui::SameLine();
    const float spacing = ImGui::GetStyle().ItemSpacing.x;
    const float keys = right - 2.0f * width - spacing;
    // What the state says has at least as much room as the monitor's name.
    const float room =
        keys - ImGui::GetCursorPosX() - button_width("Show numbers") - 2.0f * spacing;
    draw_monitor_choice(studio, std::clamp(0.5f * room, em(5.0f), em(14.0f)));
    const ProjectorWords words = projector_words(projector_facts(studio));
    draw_fitted("projector-words", words.text, colour_of(words.mood), words.help, keys);
    draw_warnings(studio, keys);
    ImGui::SameLine(keys);
    ImGui::SetCursorPosY(top);
    // A voter's letters are not the projector's, nor are the keys of a presentation.
    const bool presents = is_editing_locked(studio);
    const bool letters = letters_taken(studio) > 0 || presents;
    draw_state_button(studio,
                      "black",
                      studio.black ? "BLACK"
                      : letters    ? "Black Ctrl+B"
                                   : "Black  B",
                      studio.black,
                      width,
                      height);
    tooltip(studio.black ? "The projector is dark. B shows the picture again."
                         : "Makes the projector dark at once (B, and Ctrl+B while typing).");
    ImGui::SameLine();
    ImGui::SetCursorPosY(top);
    begin_disabled(presents);
    draw_state_button(
        studio, "freeze", studio.frozen ? "FROZEN" : "Freeze  F", studio.frozen, width, height);
    end_disabled();
    tooltip(studio.frozen
                ? "The projector keeps its picture. F shows the newest again."
                : "Keeps the projector's picture while you work on (F, and Ctrl+F while typing).");
}

void draw_status_line(Studio& studio) {
    ImGui::PushFont(small_font());
    const auto problem = studio.session.save_problem();
    if (problem) {
        ImGui::TextColored(colours::error, "NOT SAVED: %s", problem->c_str());
    } else if (const auto file = studio.session.file()) {
        ImGui::TextColored(colours::dim_text, "Saved in %s", file->c_str());
    }
    name_last_item("save-state");
    std::string right;
    const auto calibrating = studio.bench->calibrating();
    if (calibrating.running) {
        right += fmt::format(
            "Calibrating: {}, {:.0f}%", calibrating.stage, 100.0 * calibrating.fraction);
    } else if (const auto solving = studio.frames->solving()) {
        right += fmt::format("Solving: {}, {:.0f}%", solving->stage, 100.0 * solving->fraction);
    } else if (studio.background->is_busy()) {
        right += "Loading or saving…";
    }
    // Of the last picture that had to be drawn: one that was there already took no time.
    if (const double ms = studio.panels.of<PlanPanelState>().measured.total_ms;
        studio.frame && ms > 0.0) {
        right += fmt::format("{}paint to picture {:.0f} ms", right.empty() ? "" : "     ", ms);
    }
    ImGui::SameLine(ImGui::GetWindowContentRegionMax().x - ImGui::CalcTextSize(right.c_str()).x);
    ImGui::TextColored(colours::dim_text, "%s", right.c_str());
    name_last_item("progress");
    if (studio.frames->solving()) tooltip("The last finished light shows until this one is done.");
    ImGui::PopFont();
}

}  // namespace livery
