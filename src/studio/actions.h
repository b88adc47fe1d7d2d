// Everything that a key or a menu entry does: one table for menus, keys and the list of shortcuts.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace livery {

struct Studio;

/// A key of the window system with its modifiers.
struct KeyChord {
    int key = 0;
    bool ctrl = false, shift = false;
    bool operator==(const KeyChord&) const = default;
};
std::string text_of(const KeyChord& chord);  ///< "Ctrl+Shift+Z"

inline KeyChord key(int code) { return {code, false, false}; }
inline KeyChord ctrl(int code) { return {code, true, false}; }
inline KeyChord ctrl_shift(int code) { return {code, true, true}; }

struct Action {
    std::string id;    ///< "undo": does not change with the language or the layout
    std::string menu;  ///< "Edit"; empty: keys only
    std::string label;
    std::vector<KeyChord> chords = {};  ///< the first is shown
    std::function<void(Studio&)> run = {};
    std::function<bool(const Studio&)> enabled = {};  ///< none: always
    std::function<bool(const Studio&)> checked = {};  ///< none: not a switch
    std::function<std::string(const Studio&)> detail =
        {};                                      ///< behind the label: what undo would undo
    std::function<void(Studio&)> released = {};  ///< for what holds while its key is held
    bool in_dialogs = false;                     ///< also in dialogs, but for single letters
    bool in_votes = false;          ///< its keys also work while somebody fills a ballot
    bool in_presentations = false;  ///< also while frozen looks are presented and voted on
    bool starts_group = false;      ///< a line above it in the menu
    bool repeats = false;           ///< again while its key is held
};
Action line_above(Action action);  ///< starts a group
Action repeating(Action action);
Action in_dialogs(Action action);

/// Those of all panels.
const std::vector<Action>& all_actions();
/// Throws std::invalid_argument for an id that is not there.
const Action& action_named(const std::string& id);
bool is_enabled(const Action& action, const Studio& studio);
/// Runs it if it is enabled; true when it ran.
bool run_action(const Action& action, Studio& studio);

/// Who has the keyboard besides the actions.
struct KeyboardOwner {
    bool text_field = false;
    bool dialog = false;
    bool keyboard_navigation = false;  ///< the arrow keys move between items
    std::size_t ballot_letters = 0;    ///< so many letters, from A, choose designs of a ballot
};

/// The action that a key means now; none when the key is somebody else's.
const Action* action_for(const KeyChord& chord, const KeyboardOwner& owner);

}  // namespace livery
