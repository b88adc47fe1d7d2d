// Undo and redo, and taking back what is under way.
#include <GLFW/glfw3.h>

#include "core/log.h"
#include "studio/studio.h"

namespace livery {

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
