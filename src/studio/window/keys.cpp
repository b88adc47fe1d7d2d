#include "studio/window/keys.h"

#include <algorithm>

#include <GLFW/glfw3.h>
#include <imgui.h>
#include <imgui_internal.h>

#include "studio/nudge/nudge_panel.h"
#include "studio/paint/library_panel.h"
#include "studio/paint/users_library.h"
#include "studio/presenting/presenting.h"
#include "studio/seats/seats_panel.h"
#include "studio/window/actions.h"
#include "studio/window/shell.h"

namespace livery {

namespace {

// Not Caps Lock and Num Lock.
constexpr int kRealModifiers = GLFW_MOD_CONTROL | GLFW_MOD_SHIFT | GLFW_MOD_ALT | GLFW_MOD_SUPER;

KeyboardOwner keyboard_owner(const Shell& shell) {
    const ImGuiContext& g = *ImGui::GetCurrentContext();
    KeyboardOwner owner;
    // As of the last frame; WantTextInput is older by one.
    owner.text_field = g.ActiveId != 0 && g.ActiveId == g.InputTextState.ID;
    owner.dialog = ImGui::GetTopMostPopupModal() != nullptr;
    owner.ballot_letters = ballot_letters(shell.studio);
    owner.keyboard_navigation =
        g.IO.NavVisible || g.OpenPopupStack.Size > 0 || shell.studio.panels.library->owns_arrows;
    return owner;
}

}  // namespace

EventUse handle_key(Shell& shell, const InputEvent& event) {
    if (event.kind == InputEvent::Kind::focus) {
        if (!event.down) shell.studio.showing_b = false;
        if (event.down) refresh_library(shell.studio);
        return EventUse::passed_on;
    }
    if (event.code == GLFW_KEY_TAB && (event.modifiers & ~GLFW_MOD_SHIFT & kRealModifiers) == 0) {
        if (event.down) shell.tab_step = (event.modifiers & GLFW_MOD_SHIFT) != 0 ? -1 : 1;
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
            if (action.released && its_key) action.released(shell);
        }
        return EventUse::passed_on;
    }
    if ((event.modifiers & (GLFW_MOD_ALT | GLFW_MOD_SUPER)) != 0) return EventUse::passed_on;
    const KeyboardOwner owner = keyboard_owner(shell);
    const bool writes =
        owner.text_field || owner.dialog || ImGui::GetCurrentContext()->OpenPopupStack.Size > 0;
    if (shell.nudge_open && !writes && nudge_key(shell, chord)) return EventUse::step;
    const bool seats = shell.seats_open && !is_presenting(shell.studio);
    if (seats && !writes && seats_key(shell, chord)) return EventUse::step;
    if (!writes && vote_mode_key(shell, chord, event.repeated)) return EventUse::command;
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
    const bool repeats = action->id == "undo" || action->id == "redo" || action->id == "larger" ||
                         action->id == "smaller" || action->id == "next-look" ||
                         action->id == "previous-look" || action->id == "next-tab" ||
                         action->id == "previous-tab";
    if (event.repeated && !repeats) return EventUse::step;
    run_action(*action, shell);
    if (action->id != "give-up") return repeats ? EventUse::step : EventUse::command;
    if (ImGui::IsAnyItemActive()) ImGui::ClearActiveID();
    return EventUse::passed_on;  // Panels may have something of their own to give up.
}

}  // namespace livery
