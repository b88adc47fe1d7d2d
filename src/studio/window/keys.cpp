// What keys do in the window, wherever the keyboard is; undo, redo, and taking back what is under
// way.
#include <algorithm>

#include <GLFW/glfw3.h>
#include <imgui.h>
#include <imgui_internal.h>

#include "core/log.h"
#include "studio/studio.h"
#include "studio/users_library.h"
#include "studio/window/layout.h"

namespace livery {

namespace {

// Not Caps Lock and Num Lock.
constexpr int kRealModifiers = GLFW_MOD_CONTROL | GLFW_MOD_SHIFT | GLFW_MOD_ALT | GLFW_MOD_SUPER;

KeyboardOwner keyboard_owner(const Studio& studio) {
    const ImGuiContext& g = *ImGui::GetCurrentContext();
    KeyboardOwner owner;
    // As of the last frame; WantTextInput is older by one.
    owner.text_field = g.ActiveId != 0 && g.ActiveId == g.InputTextState.ID;
    owner.dialog = ImGui::GetTopMostPopupModal() != nullptr;
    owner.ballot_letters = letters_taken(studio);
    owner.keyboard_navigation = g.IO.NavVisible || g.OpenPopupStack.Size > 0 ||
                                studio.arrows_taken_in_frame == ImGui::GetFrameCount();
    return owner;
}

}  // namespace

EventUse handle_key(Studio& studio, const InputEvent& event) {
    if (event.kind == InputEvent::Kind::focus) {
        if (!event.down) studio.showing_b = false;
        if (event.down) refresh_library(studio);
        return EventUse::passed_on;
    }
    if (event.code == GLFW_KEY_TAB && (event.modifiers & ~GLFW_MOD_SHIFT & kRealModifiers) == 0) {
        if (event.down) studio.tab_step = (event.modifiers & GLFW_MOD_SHIFT) != 0 ? -1 : 1;
        return EventUse::command;
    }
    const KeyChord chord{event.code,
                         (event.modifiers & GLFW_MOD_CONTROL) != 0,
                         (event.modifiers & GLFW_MOD_SHIFT) != 0};
    if (!event.down) {
        // Whatever the modifiers are by now: what was held is let go.
        for (const Action& action : all_actions()) {
            const bool its_key =
                std::any_of(action.chords.begin(), action.chords.end(), [&](const KeyChord& c) {
                    return c.key == event.code;
                });
            if (action.released && its_key) action.released(studio);
        }
        return EventUse::passed_on;
    }
    if ((event.modifiers & (GLFW_MOD_ALT | GLFW_MOD_SUPER)) != 0) return EventUse::passed_on;
    const KeyboardOwner owner = keyboard_owner(studio);
    const bool writes =
        owner.text_field || owner.dialog || ImGui::GetCurrentContext()->OpenPopupStack.Size > 0;
    for (const Panel& panel : all_panels()) {
        if (writes || !panel.press) continue;
        const EventUse use = panel.press(studio, chord, event.repeated);
        if (use != EventUse::passed_on) return use;
    }
    const Action* action = action_for(chord, owner);
    // Dear ImGui has a meaning of its own for Tab and would use it for its list of windows.
    if (!action && chord.key == GLFW_KEY_TAB) return EventUse::command;
    if (!action) {
        const bool nobodys = chord.key == GLFW_KEY_SPACE && !owner.text_field && !owner.dialog;
        return nobodys ? EventUse::step : EventUse::passed_on;
    }
    // Esc closes an open menu, and that is all it does then.
    ImGuiContext& g = *ImGui::GetCurrentContext();
    if (action->id == "give-up" && !owner.dialog && g.OpenPopupStack.Size > 0) {
        ImGui::ClosePopupToLevel(0, false);
        g.NavDisableHighlight = true;
        g.NavLayer = ImGuiNavLayer_Main;
        return EventUse::command;
    }
    if (event.repeated && !action->repeats) return EventUse::step;
    run_action(*action, studio);
    if (action->id != "give-up") return action->repeats ? EventUse::step : EventUse::command;
    if (ImGui::IsAnyItemActive()) ImGui::ClearActiveID();
    return EventUse::passed_on;  // Panels may have something of their own to give up.
}

namespace {

void step_history(Studio& studio, bool back) {
    stop_trying(studio);
    Session& session = studio.session;
    log_line(LogLevel::info,
             back ? "undo: " + session.undo_label() : "redo: " + session.redo_label());
    const auto look = back ? session.undo() : session.redo();
    keep_shown_looks_valid(studio);
    if (look) show_look(studio, *look);
}

bool give_up_in_panel(Studio& studio, bool before_trials) {
    for (const Panel& panel : all_panels()) {
        const bool is_before = panel.place == PanelPlace::page || panel.place == PanelPlace::tab;
        if (is_before != before_trials) continue;
        if (panel.esc_closes && panel.is_open(studio)) {
            panel.show(studio, false);
            return true;
        }
        if (panel.give_up && panel.give_up(studio)) return true;
    }
    return false;
}

/// One thing at a time, the topmost first.
void give_up(Studio& studio) {
    if (give_up_in_panel(studio, true)) {
    } else if (studio.tried || studio.trying) {
        stop_trying(studio);
    } else if (give_up_in_panel(studio, false)) {
    } else if (!studio.notices.empty()) {
        studio.notices.pop_back();
    } else if (studio.wiping) {
        studio.wiping = false;
    } else {
        studio.selected_part.reset();
    }
    studio.gave_up = true;
}

std::vector<Action> editing_actions() {
    Action undo{
        "undo", "Edit", "Undo", {ctrl(GLFW_KEY_Z)}, [](Studio& s) { step_history(s, true); }};
    undo.enabled = [](const Studio& s) { return s.session.can_undo(); };
    undo.detail = [](const Studio& s) { return s.session.undo_label(); };
    Action redo{"redo", "Edit", "Redo", {ctrl(GLFW_KEY_Y), ctrl_shift(GLFW_KEY_Z)}, [](Studio& s) {
                    step_history(s, false);
                }};
    redo.enabled = [](const Studio& s) { return s.session.can_redo(); };
    redo.detail = [](const Studio& s) { return s.session.redo_label(); };
    return {
        repeating(undo),
        repeating(redo),
        line_above(
            {"give-up", "Edit", "Take back what is being tried", {key(GLFW_KEY_ESCAPE)}, give_up})};
}

}  // namespace

Panel editing_panel() { return {.name = "editing", .actions = editing_actions}; }

}  // namespace livery
