// Everything that a key or a menu entry does: one table for menus, keys and the list of shortcuts.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace livery {

struct Shell;

/// A key of the window system with its modifiers.
struct KeyChord {
    int key = 0;
    bool ctrl = false, shift = false;
    bool operator==(const KeyChord&) const = default;
};
std::string text_of(const KeyChord& chord);  ///< "Ctrl+Shift+Z"

struct Action {
    std::string id;    ///< "undo": does not change with the language or the layout
    std::string menu;  ///< "Edit"; empty: keys only
    std::string label;
    std::vector<KeyChord> chords;  ///< the first is shown
    std::function<void(Shell&)> run;
    std::function<bool(const Shell&)> enabled;        ///< none: always
    std::function<bool(const Shell&)> checked;        ///< none: not a switch
    std::function<std::string(const Shell&)> detail;  ///< behind the label: what undo would undo
    std::function<void(Shell&)> released;             ///< for what holds while its key is held
    bool in_dialogs = false;                          ///< also in dialogs, but for single letters
    bool in_votes = false;          ///< its keys also work while somebody fills a ballot
    bool in_presentations = false;  ///< also while frozen looks are presented and voted on
    bool starts_group = false;      ///< a line above it in the menu
};

const std::vector<Action>& all_actions();
/// Throws std::invalid_argument for an id that is not there.
const Action& action_named(const std::string& id);
bool is_enabled(const Action& action, const Shell& shell);
/// Runs it if it is enabled; true when it ran.
bool run_action(const Action& action, Shell& shell);

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
