// Tab and Shift+Tab through everything that can be pressed, chosen or typed in, in the order in
// which it is drawn. (Dear ImGui's own Tab stops at text fields only.) Main thread.
#pragma once

#include <optional>
#include <string>

namespace livery {

/// Forgets the last frame's, and the undo steps of a text field that is left; to be called before
/// anything is drawn.
void start_tab_order();
/// The item just drawn is a stop, unless nothing can be done with it; name_last_item() calls this.
void note_tab_stop(const std::string& name);

/// What is drawn between the two is one stop, inside of which the arrow keys move: `preferred` (an
/// item's id), else the first.
void begin_tab_group();
void end_tab_group(std::optional<unsigned> preferred);

/// After everything is drawn: the keyboard goes to the next (1) or the one before (-1), in the
/// topmost dialog or list when one is open. A field is typed in at once.
void move_focus(int step);

/// Before a text field is drawn in the current window with this label: it is typed in from the next
/// frame on, wherever the keyboard is. (Dear ImGui 1.90's SetKeyboardFocusHere() does nothing while
/// another item has the keyboard.)
void focus_next_field(const char* label);

/// Where the keyboard is, by the name of its item; empty: nowhere, or its frame is not shown.
std::string focused_item();

}  // namespace livery
