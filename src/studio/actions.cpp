#include "studio/actions.h"

#include <algorithm>
#include <stdexcept>

#include <GLFW/glfw3.h>
#include <fmt/format.h>

#include "studio/studio.h"

namespace livery {

namespace {

/// While people vote, keys show looks and do nothing to them: whoever votes sits at the keyboard.
/// While frozen looks are presented and voted on, nothing else is shown either.
void allow_in_votes(std::vector<Action>& list) {
    for (Action& one : list) {
        const bool shows = one.id.starts_with("look-") || one.id == "next-look" ||
                           one.id == "previous-look" || one.id == "hold-b" || one.id == "wipe";
        one.in_presentations = one.menu == "View" || one.menu == "Help" || one.id == "black" ||
                               one.id == "give-up" || one.id == "quit";
        one.in_votes = shows || one.in_dialogs || one.menu == "View" || one.menu == "Projector" ||
                       one.menu == "Help" || one.id == "give-up";
    }
}

std::vector<Action> make_actions() {
    std::vector<Action> list;
    for (const Panel& panel : all_panels()) {
        if (!panel.actions) continue;
        for (Action& action : panel.actions()) list.push_back(std::move(action));
    }
    allow_in_votes(list);
    return list;
}

std::string name_of(int code) {
    static const std::pair<int, const char*> names[] = {{GLFW_KEY_ESCAPE, "Esc"},
                                                        {GLFW_KEY_SPACE, "Space"},
                                                        {GLFW_KEY_DELETE, "Del"},
                                                        {GLFW_KEY_TAB, "Tab"},
                                                        {GLFW_KEY_PAGE_UP, "PgUp"},
                                                        {GLFW_KEY_PAGE_DOWN, "PgDn"},
                                                        {GLFW_KEY_LEFT, "←"},
                                                        {GLFW_KEY_RIGHT, "→"},
                                                        {GLFW_KEY_UP, "↑"},
                                                        {GLFW_KEY_DOWN, "↓"},
                                                        {GLFW_KEY_EQUAL, "+"},
                                                        {GLFW_KEY_MINUS, "−"},
                                                        {GLFW_KEY_GRAVE_ACCENT, "`"},
                                                        {GLFW_KEY_SLASH, "/"}};
    for (const auto& [named, name] : names) {
        if (named == code) return name;
    }
    if (code >= GLFW_KEY_F1 && code <= GLFW_KEY_F12)
        return fmt::format("F{}", code - GLFW_KEY_F1 + 1);
    return std::string(1, static_cast<char>(code));
}

}  // namespace

std::string text_of(const KeyChord& chord) {
    if (chord == KeyChord{GLFW_KEY_SLASH, false, true}) return "?";
    return (chord.ctrl ? "Ctrl+" : "") + std::string(chord.shift ? "Shift+" : "") +
           name_of(chord.key);
}

Action line_above(Action action) {
    action.starts_group = true;
    return action;
}

Action repeating(Action action) {
    action.repeats = true;
    return action;
}

Action in_dialogs(Action action) {
    action.in_dialogs = true;
    return action;
}

const std::vector<Action>& all_actions() {
    static const std::vector<Action> actions = make_actions();
    return actions;
}

const Action& action_named(const std::string& id) {
    for (const Action& action : all_actions()) {
        if (action.id == id) return action;
    }
    throw std::invalid_argument("no action is called \"" + id + "\"");
}

bool is_enabled(const Action& action, const Studio& studio) {
    if (!action.in_presentations && is_editing_locked(studio)) return false;
    return !action.enabled || action.enabled(studio);
}

bool run_action(const Action& action, Studio& studio) {
    if (!action.in_presentations && refuse_editing(studio)) return false;
    if (!is_enabled(action, studio)) return false;
    action.run(studio);
    studio.last_action = action.id;
    ++studio.actions_run;
    return true;
}

const Action* action_for(const KeyChord& chord, const KeyboardOwner& owner) {
    const bool arrow = chord.key == GLFW_KEY_LEFT || chord.key == GLFW_KEY_RIGHT;
    if (arrow && owner.keyboard_navigation) return nullptr;
    for (const Action& action : all_actions()) {
        const auto& chords = action.chords;
        if (std::find(chords.begin(), chords.end(), chord) == chords.end()) continue;
        const bool letter = !chord.ctrl && chord.key >= GLFW_KEY_A && chord.key <= GLFW_KEY_Z;
        if (owner.dialog && (letter || !action.in_dialogs)) return nullptr;
        if (owner.ballot_letters > 0) {
            if (!action.in_votes) return nullptr;
            if (letter && static_cast<std::size_t>(chord.key - GLFW_KEY_A) < owner.ballot_letters) {
                return nullptr;
            }
        }
        // A text field keeps what it has a meaning for; black and freeze go before everything.
        const bool is_function_key = chord.key >= GLFW_KEY_F1 && chord.key <= GLFW_KEY_F12;
        const bool always = action.in_dialogs && chord.ctrl;
        const bool turns_tabs = chord.ctrl && chord.key == GLFW_KEY_TAB;
        if (owner.text_field && !always && !is_function_key && !turns_tabs) return nullptr;
        return &action;
    }
    return nullptr;
}

}  // namespace livery
