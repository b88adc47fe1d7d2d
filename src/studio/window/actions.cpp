#include "studio/window/actions.h"

#include <algorithm>
#include <stdexcept>

#include <GLFW/glfw3.h>
#include <fmt/format.h>

#include "core/log.h"
#include "studio/artwork/artwork_edit.h"
#include "studio/capture/capture_panel.h"
#include "studio/light/lighting_panel.h"
#include "studio/look_files.h"
#include "studio/nudge/nudge_panel.h"
#include "studio/paint/library_panel.h"
#include "studio/presenting/presenting.h"
#include "studio/product/new_session.h"
#include "studio/product/open_session.h"
#include "studio/projector_control.h"
#include "studio/report/report_window.h"
#include "studio/seats/seat_maps.h"
#include "studio/seats/seats_panel.h"
#include "studio/window/shell.h"

namespace livery {

namespace {

KeyChord key(int code) { return {code, false, false}; }
KeyChord ctrl(int code) { return {code, true, false}; }
KeyChord ctrl_shift(int code) { return {code, true, true}; }

const std::vector<SessionLook>& looks_of(const Shell& shell) {
    return shell.studio.session.document().looks;
}

bool has_several_looks(const Shell& shell) { return looks_of(shell).size() > 1; }
bool has_compared_look(const Shell& shell) { return shell.studio.compared_look.has_value(); }

void undo(Shell& shell) {
    Studio& studio = shell.studio;
    stop_trying(studio);
    log_line(LogLevel::info, "undo: " + studio.session.undo_label());
    const auto look = studio.session.undo();
    keep_shown_looks_valid(studio);
    if (look) show_look(studio, *look);
}

void redo(Shell& shell) {
    Studio& studio = shell.studio;
    stop_trying(studio);
    log_line(LogLevel::info, "redo: " + studio.session.redo_label());
    const auto look = studio.session.redo();
    keep_shown_looks_valid(studio);
    if (look) show_look(studio, *look);
}

void show_look_at(Shell& shell, std::size_t place) {
    if (place >= looks_of(shell).size()) return;
    stop_trying(shell.studio);
    show_look(shell.studio, looks_of(shell)[place].id);
}

void step_look(Shell& shell, int step) {
    const auto count = static_cast<int>(looks_of(shell).size());
    const auto place = static_cast<int>(shell.studio.shown_place) + step;
    show_look_at(shell, static_cast<std::size_t>((place + count) % count));
}

void add_look(Shell& shell) {
    Look look = find_look(shell.studio.session.document(), shell.studio.shown_look)->look;
    look.name = "new look";
    look.parts.clear();
    commit(shell.studio, AddLook{look, -1});
}

void use_scale(Shell& shell, double scale) {
    shell.user_scale = std::clamp(scale, 0.75, 3.0);
    shell.studio.session.set_workspace("scale", fmt::format("{:.2f}", shell.user_scale));
}

void show_view(Shell& shell, StageView view) {
    shell.studio.view = view;
    shell.clicked_a_view = true;
    show_seat_map(shell.studio, false);
}

/// One thing at a time, the topmost first.
void give_up(Shell& shell) {
    Studio& studio = shell.studio;
    if (shell.help_open || shell.about_open) {
        shell.help_open = shell.about_open = false;
    } else if (studio.panels.report->open) {
        show_report_window(studio, false);
    } else if (studio.panels.lighting->accuracy.open) {
        show_accuracy_page(studio, false);
    } else if (is_placing(studio)) {
        stop_placing(studio);
        stop_trying(studio);
    } else if (studio.tried || studio.trying) {
        stop_trying(studio);
    } else if (shell.nudge_open) {
        show_nudge(shell, false);
    } else if (shell.seats_open) {
        show_seats(shell, false);
    } else if (studio.renaming_look) {
        studio.renaming_look.reset();
    } else if (!studio.notices.empty()) {
        studio.notices.pop_back();
    } else if (studio.wiping) {
        studio.wiping = false;
    } else {
        studio.selected_part.reset();
    }
    studio.gave_up = true;
}

Action action(std::string id,
              std::string menu,
              std::string label,
              std::vector<KeyChord> chords,
              std::function<void(Shell&)> run) {
    Action result;
    result.id = std::move(id);
    result.menu = std::move(menu);
    result.label = std::move(label);
    result.chords = std::move(chords);
    result.run = std::move(run);
    return result;
}

void add_file_actions(std::vector<Action>& list) {
    list.push_back(
        action("new-session", "File", "New session…", {ctrl(GLFW_KEY_N)}, ask_for_product));
    list.push_back(
        action("open-session", "File", "Open session…", {ctrl(GLFW_KEY_O)}, ask_for_session));
    list.push_back(
        action("import-look", "File", "Import look…", {ctrl(GLFW_KEY_I)}, ask_for_look_file));
    list.back().starts_group = true;
    list.push_back(action(
        "export-look", "File", "Export look…", {ctrl(GLFW_KEY_E)}, ask_where_to_export_look));
    list.push_back(action(
        "export-product", "File", "Export product with looks…", {}, ask_where_to_export_product));
    list.push_back(action("save-session-as",
                          "File",
                          "Save session as…",
                          {ctrl_shift(GLFW_KEY_S)},
                          ask_where_to_save_session));
    list.back().starts_group = true;
    list.push_back(action(
        "save-picture", "File", "Save picture…", {ctrl(GLFW_KEY_S)}, ask_where_to_save_picture));
    list.back().starts_group = true;
    list.push_back(action("capture", "Projector", "Capture with a camera…", {}, [](Shell& s) {
        show_capture(s, !s.capture_open);
    }));
    list.back().checked = [](const Shell& s) { return s.capture_open; };
    list.push_back(action("nudge", "Projector", "Move the mock-up by hand…", {}, [](Shell& s) {
        show_nudge(s, !s.nudge_open);
    }));
    list.back().enabled = [](const Shell& s) { return !s.capture_open; };
    list.back().checked = [](const Shell& s) { return s.nudge_open; };
    list.push_back(action("seats", "Projector", "Seats in the room…", {}, [](Shell& s) {
        show_seats(s, !s.seats_open);
    }));
    list.back().checked = [](const Shell& s) { return s.seats_open; };
    list.push_back(
        action("ballot", "File", "Ballot", {}, [](Shell& s) { s.ballots_open = !s.ballots_open; }));
    list.back().checked = [](const Shell& s) { return s.ballots_open; };
    list.push_back(
        action("quit", "File", "Quit", {ctrl(GLFW_KEY_Q)}, [](Shell& s) { s.quit = true; }));
    list.back().starts_group = true;
    list.back().in_dialogs = true;
}

void add_edit_actions(std::vector<Action>& list) {
    list.push_back(action("undo", "Edit", "Undo", {ctrl(GLFW_KEY_Z)}, undo));
    list.back().enabled = [](const Shell& s) { return s.studio.session.can_undo(); };
    list.back().detail = [](const Shell& s) { return s.studio.session.undo_label(); };
    list.push_back(
        action("redo", "Edit", "Redo", {ctrl(GLFW_KEY_Y), ctrl_shift(GLFW_KEY_Z)}, redo));
    list.back().enabled = [](const Shell& s) { return s.studio.session.can_redo(); };
    list.back().detail = [](const Shell& s) { return s.studio.session.redo_label(); };
    list.push_back(action(
        "give-up", "Edit", "Take back what is being tried", {key(GLFW_KEY_ESCAPE)}, give_up));
    list.back().starts_group = true;
    list.push_back(action("find-paint",
                          "Edit",
                          "Find a paint",
                          {key(GLFW_KEY_SLASH), ctrl(GLFW_KEY_K)},
                          [](Shell& s) {
                              s.tab_to_open = 0;
                              s.studio.panels.library->focus_search = true;
                          }));
}

void add_look_actions(std::vector<Action>& list) {
    list.push_back(action("new-look", "Look", "New", {key(GLFW_KEY_N)}, add_look));
    list.push_back(action("duplicate-look", "Look", "Duplicate", {ctrl(GLFW_KEY_D)}, [](Shell& s) {
        commit(s.studio, DuplicateLook{s.studio.shown_look});
    }));
    list.push_back(action("rename-look", "Look", "Rename", {key(GLFW_KEY_F2)}, [](Shell& s) {
        s.studio.renaming_look = s.studio.shown_look;
    }));
    list.push_back(action("delete-look", "Look", "Delete", {key(GLFW_KEY_DELETE)}, [](Shell& s) {
        stop_trying(s.studio);
        commit(s.studio, DeleteLook{s.studio.shown_look});
    }));
    list.back().enabled = has_several_looks;
    list.push_back(action("move-look-up", "Look", "Move up", {ctrl(GLFW_KEY_UP)}, [](Shell& s) {
        commit(s.studio, MoveLook{s.studio.shown_look, static_cast<int>(s.studio.shown_place) - 1});
    }));
    list.back().starts_group = true;
    list.back().enabled = [](const Shell& s) { return s.studio.shown_place > 0; };
    list.push_back(
        action("move-look-down", "Look", "Move down", {ctrl(GLFW_KEY_DOWN)}, [](Shell& s) {
            commit(s.studio,
                   MoveLook{s.studio.shown_look, static_cast<int>(s.studio.shown_place) + 1});
        }));
    list.back().enabled = [](const Shell& s) {
        return s.studio.shown_place + 1 < looks_of(s).size();
    };
    list.push_back(
        action("share-lighting", "Look", "Light all looks like this one", {}, [](Shell& s) {
            commit(s.studio, ShareLighting{s.studio.shown_look});
        }));
    list.back().enabled = has_several_looks;
    list.push_back(action(
        "next-look", "Look", "Next", {key(GLFW_KEY_PAGE_DOWN), key(GLFW_KEY_RIGHT)}, [](Shell& s) {
            step_look(s, 1);
        }));
    list.back().starts_group = true;
    list.back().enabled = has_several_looks;
    list.push_back(action("previous-look",
                          "Look",
                          "Previous",
                          {key(GLFW_KEY_PAGE_UP), key(GLFW_KEY_LEFT)},
                          [](Shell& s) { step_look(s, -1); }));
    list.back().enabled = has_several_looks;
    for (int n = 1; n <= 9; ++n) {
        list.push_back(action(fmt::format("look-{}", n),
                              "",
                              fmt::format("Show look {}", n),
                              {key(GLFW_KEY_0 + n), key(GLFW_KEY_KP_0 + n)},
                              [n](Shell& s) { show_look_at(s, static_cast<std::size_t>(n - 1)); }));
        list.back().enabled = [n](const Shell& s) {
            return static_cast<std::size_t>(n) <= looks_of(s).size();
        };
    }
    list.push_back(action("hold-b",
                          "",
                          "Show B while held",
                          {key(GLFW_KEY_SPACE), key(GLFW_KEY_GRAVE_ACCENT)},
                          [](Shell& s) { s.studio.showing_b = true; }));
    list.back().released = [](Shell& s) { s.studio.showing_b = false; };
    list.back().enabled = has_compared_look;
    list.push_back(action("wipe", "Look", "Wipe between A and B", {key(GLFW_KEY_W)}, [](Shell& s) {
        s.studio.wiping = !s.studio.wiping;
    }));
    list.back().starts_group = true;
    list.back().enabled = has_compared_look;
    list.back().checked = [](const Shell& s) { return s.studio.wiping; };
}

void add_view_actions(std::vector<Action>& list) {
    const auto view = [&](const char* id, const char* label, int function_key, StageView what) {
        list.push_back(action(
            id, "View", label, {key(function_key)}, [what](Shell& s) { show_view(s, what); }));
        list.back().checked = [what](const Shell& s) { return s.studio.view == what; };
    };
    view("view-preview", "Preview", GLFW_KEY_F5, StageView::preview);
    view("view-eye", "From the audience's eye", GLFW_KEY_F6, StageView::eye);
    view("view-projector", "Projector picture", GLFW_KEY_F7, StageView::projector);
    view("view-photograph", "Photograph of the mock-up", GLFW_KEY_F8, StageView::photograph);
    const auto turn_tabs = [](int step) {
        return [step](Shell& s) { s.tab_to_open = (s.open_tab + step + kTabs) % kTabs; };
    };
    list.push_back(action("next-tab",
                          "View",
                          "Next tab",
                          {ctrl(GLFW_KEY_TAB), ctrl(GLFW_KEY_PAGE_DOWN)},
                          turn_tabs(1)));
    list.back().starts_group = true;
    list.push_back(action("previous-tab",
                          "View",
                          "Previous tab",
                          {ctrl_shift(GLFW_KEY_TAB), ctrl(GLFW_KEY_PAGE_UP)},
                          turn_tabs(-1)));
    list.push_back(action("accuracy-page", "View", "What accuracy costs", {}, [](Shell& s) {
        show_accuracy_page(s.studio, !s.studio.panels.lighting->accuracy.open);
    }));
    list.back().checked = [](const Shell& s) { return s.studio.panels.lighting->accuracy.open; };
    list.back().starts_group = true;
    list.push_back(action("larger",
                          "View",
                          "Larger",
                          {ctrl(GLFW_KEY_EQUAL), ctrl_shift(GLFW_KEY_EQUAL), ctrl(GLFW_KEY_KP_ADD)},
                          [](Shell& s) { use_scale(s, s.user_scale * 1.1); }));
    list.back().starts_group = true;
    list.push_back(action("smaller",
                          "View",
                          "Smaller",
                          {ctrl(GLFW_KEY_MINUS), ctrl(GLFW_KEY_KP_SUBTRACT)},
                          [](Shell& s) { use_scale(s, s.user_scale / 1.1); }));
    list.push_back(action(
        "usual-size", "View", "Usual size", {ctrl(GLFW_KEY_0), ctrl(GLFW_KEY_KP_0)}, [](Shell& s) {
            use_scale(s, 1.0);
        }));
}

void add_projector_actions(std::vector<Action>& list) {
    list.push_back(
        action("black", "Projector", "Black", {key(GLFW_KEY_B), ctrl(GLFW_KEY_B)}, [](Shell& s) {
            set_black(s, !is_black(s));
        }));
    list.back().checked = [](const Shell& s) { return is_black(s); };
    list.back().in_dialogs = true;
    list.push_back(
        action("freeze", "Projector", "Freeze", {key(GLFW_KEY_F), ctrl(GLFW_KEY_F)}, [](Shell& s) {
            set_frozen(s, !is_frozen(s));
        }));
    list.back().checked = [](const Shell& s) { return is_frozen(s); };
    list.back().in_dialogs = true;
    list.push_back(action(
        "monitor-numbers", "Projector", "Show numbers on the monitors", {}, show_monitor_numbers));
    list.back().starts_group = true;
    list.push_back(
        action("signal-test", "Projector", "Test picture for the signal", {}, [](Shell& s) {
            show_signal_test(s, !s.signal_test_open);
        }));
    list.back().checked = [](const Shell& s) { return s.signal_test_open; };
}

void add_help_actions(std::vector<Action>& list) {
    list.push_back(action("shortcuts",
                          "Help",
                          "Keys",
                          {key(GLFW_KEY_F1), {GLFW_KEY_SLASH, false, true}},
                          [](Shell& s) { s.help_open = !s.help_open; }));
    list.push_back(action("report-problem", "Help", "Report a problem…", {}, [](Shell& s) {
        show_report_window(s.studio, !s.studio.panels.report->open, s.drawn_with);
    }));
    list.back().checked = [](const Shell& s) { return s.studio.panels.report->open; };
    list.back().starts_group = true;
    list.push_back(
        action("about", "Help", "About Livery", {}, [](Shell& s) { s.about_open = true; }));
}

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
    add_file_actions(list);
    add_edit_actions(list);
    add_view_actions(list);
    add_look_actions(list);
    add_projector_actions(list);
    add_help_actions(list);
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

bool is_enabled(const Action& action, const Shell& shell) {
    if (!action.in_presentations && is_presenting(shell.studio)) return false;
    return !action.enabled || action.enabled(shell);
}

bool run_action(const Action& action, Shell& shell) {
    if (!action.in_presentations && refuse_editing(shell.studio)) return false;
    if (!is_enabled(action, shell)) return false;
    action.run(shell);
    shell.last_action = action.id;
    ++shell.actions_run;
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
