// Every entry of the table of actions in the real window, by menu and by key, in a session and
// beside each dialog.
#include "studio/actions.h"

#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include <GLFW/glfw3.h>
#include <gtest/gtest.h>

#include "desktop/two_monitors.h"

namespace livery {
namespace {

/// As X names the key.
std::string x_name(const KeyChord& chord) {
    static const std::map<int, std::string> names = {{GLFW_KEY_ESCAPE, "Escape"},
                                                     {GLFW_KEY_SPACE, "space"},
                                                     {GLFW_KEY_DELETE, "Delete"},
                                                     {GLFW_KEY_TAB, "Tab"},
                                                     {GLFW_KEY_PAGE_UP, "Prior"},
                                                     {GLFW_KEY_PAGE_DOWN, "Next"},
                                                     {GLFW_KEY_LEFT, "Left"},
                                                     {GLFW_KEY_RIGHT, "Right"},
                                                     {GLFW_KEY_UP, "Up"},
                                                     {GLFW_KEY_DOWN, "Down"},
                                                     {GLFW_KEY_EQUAL, "equal"},
                                                     {GLFW_KEY_MINUS, "minus"},
                                                     {GLFW_KEY_GRAVE_ACCENT, "grave"},
                                                     {GLFW_KEY_SLASH, "slash"},
                                                     {GLFW_KEY_KP_ADD, "KP_Add"},
                                                     {GLFW_KEY_KP_SUBTRACT, "KP_Subtract"}};
    std::string key;
    if (const auto found = names.find(chord.key); found != names.end()) {
        key = found->second;
    } else if (chord.key >= GLFW_KEY_F1 && chord.key <= GLFW_KEY_F12) {
        key = "F" + std::to_string(chord.key - GLFW_KEY_F1 + 1);
    } else if (chord.key >= GLFW_KEY_KP_0 && chord.key <= GLFW_KEY_KP_9) {
        key = "KP_" + std::to_string(chord.key - GLFW_KEY_KP_0);
    } else {
        key = std::string(1, static_cast<char>(chord.key));
        if (key[0] >= 'A' && key[0] <= 'Z') key[0] = static_cast<char>(key[0] - 'A' + 'a');
    }
    return std::string(chord.ctrl ? "ctrl+" : "") + (chord.shift ? "shift+" : "") + key;
}

class Actions : public TwoMonitors {
  protected:
    /// As a person gives up what is open: Esc until nothing is.
    void close_dialogs() {
        for (int tries = 0; tries < 6 && program->state("dialog") == true; ++tries) {
            program->press_key("Escape");
        }
        ASSERT_EQ(program->state("dialog"), false) << program->words();
    }

    /// Presses the key and says what ran; empty where nothing did.
    std::string ran_by_key(const KeyChord& chord) {
        const int before = program->state("actions");
        program->press_key(x_name(chord));
        return program->state("actions") == before ? "" : program->state("action");
    }

    void choose(const Action& action) {
        program->click("menu:" + action.menu);
        program->click("menu:" + action.id);
        // A disabled entry leaves the menu open.
        if (program->has_item("menu:" + action.id)) program->press_key("Escape");
    }

    /// Panels that are no dialogs are closed where they were opened.
    void put_away(const Action& action) {
        close_dialogs();
        const bool panel = action.id == "capture" || action.id == "nudge" || action.id == "seats" ||
                           action.id == "ballot" || action.id == "accuracy-page" ||
                           action.id == "signal-test" || action.id == "black" ||
                           action.id == "freeze";
        if (panel) choose(action);
        const bool text = action.id == "find-paint" || action.id == "rename-look";
        if (text || action.menu == "Help") program->press_key("Escape");
    }

    /// In a dialog single letters and what changes the session rest; Ctrl+B and Ctrl+F do not.
    void press_all_beside(const std::string& dialog) {
        const Action& opens = action_named(dialog);
        for (const Action& action : all_actions()) {
            if (action.id == "quit") continue;
            for (const KeyChord& chord : action.chords) {
                if (program->state("dialog") != true) choose(opens);
                ASSERT_EQ(program->state("dialog"), true) << dialog;
                const std::string ran = ran_by_key(chord);
                ASSERT_TRUE(program->process().running()) << dialog << ", then " << text_of(chord);
                const std::string pressed = dialog + ", then " + text_of(chord);
                EXPECT_EQ(ran, action.in_dialogs && chord.ctrl ? action.id : "") << pressed;
                if (ran.empty()) continue;
                EXPECT_EQ(ran_by_key(chord), ran) << pressed << ", back";
            }
        }
        close_dialogs();
    }
};

TEST_F(Actions, EachIsPressedByMenuAndByKey) {
    use_shared();
    for (const Action& action : all_actions()) {
        SCOPED_TRACE(action.id);
        if (action.id == "quit") continue;  // StudioProgram::quit()
        if (!action.menu.empty()) {
            const int before = program->state("actions");
            choose(action);
            if (!action.enabled) {
                EXPECT_GT(program->state("actions"), before) << "by menu";
            }
            put_away(action);
        }
        for (const KeyChord& chord : action.chords) {
            const std::string ran = ran_by_key(chord);
            // Arrows move between items where the keyboard is on one.
            const bool arrow = chord.key == GLFW_KEY_LEFT || chord.key == GLFW_KEY_RIGHT;
            if (!action.enabled && !arrow) {
                EXPECT_EQ(ran, action.id) << text_of(chord);
            }
            if (!ran.empty()) put_away(action_named(ran));
        }
    }
    // The last size is the first, and the window is as it was made for it.
    program->wait_for_state("scale", 1.0);
}

TEST_F(Actions, RestBesideADialogButForBlackAndFreeze) {
    use_shared();
    press_all_beside("save-picture");
}

TEST_F(Actions, NightlyRestBesideEachDialog) {
    use_shared();
    for (const char* dialog : {"new-session",
                               "open-session",
                               "import-look",
                               "export-look",
                               "export-product",
                               "save-session-as"}) {
        press_all_beside(dialog);
    }
}

TEST_F(Actions, ButtonsAboveThePictureStandBesideOneAnotherAtEachSize) {
    use_shared();
    const std::vector<std::string> names = {
        "view:preview", "view:eye", "view:projector", "view:photograph", "hold-b", "wipe"};
    for (int size = 0; size < 13; ++size) {
        for (const std::string& one : names) {
            for (const std::string& other : names) {
                if (one >= other) continue;
                const Rectangle a = program->item(one), b = program->item(other);
                const bool apart = a.x + a.width <= b.x || b.x + b.width <= a.x ||
                                   a.y + a.height <= b.y || b.y + b.height <= a.y;
                EXPECT_TRUE(apart) << one << " on " << other << " at " << program->state("scale");
            }
        }
        program->press_key("ctrl+equal");
    }
    program->press_key("ctrl+0");
}

}  // namespace
}  // namespace livery
