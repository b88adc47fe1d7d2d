// Items of the window by their names: for `--ui-map FILE`, where everything is and what it shows,
// for other programs; and for Tab and Shift+Tab, which go through everything that can be pressed,
// chosen or typed in, in the order in which it is drawn. (Dear ImGui's own Tab stops at text fields
// only.) Main thread.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace livery {

/// Pixels of the window; what is scrolled out of sight is not in the map.
struct ItemPlace {
    int x = 0, y = 0, width = 0, height = 0;
    bool operator==(const ItemPlace&) const = default;
};
using ItemPlaces = std::map<std::string, ItemPlace>;

/// name_last_item() adds to these between the two, and to the order of Tab.
void start_naming_items(bool wanted);
ItemPlaces take_named_items();
/// Remembers where the item just drawn is on the screen, under a name that does not depend on the
/// layout ("paint:solid red", "look:2", "undo"): for `--ui-map FILE`, by which tests and other
/// programs drive the window.
void name_last_item(const std::string& name);
/// For what is not one item: a rectangle of the screen.
void name_rectangle(const std::string& name, float x, float y, float width, float height);

/// What the window shows, as names and JSON values ("true", "3", "\"preview\"").
using MapState = std::map<std::string, std::string>;
std::string map_text(bool value);
std::string map_text(const std::string& value);  ///< quoted
std::string map_text(const char* value);
std::string map_text(const std::optional<int>& value);  ///< or "null"
std::string map_text(const MapState& object);

std::string ui_map_text(const ItemPlaces& items,
                        const MapState& state,
                        const ItemPlace& window_on_desktop);

/// Writes when something changed: to a file beside it, then renamed, so that a reader never sees
/// half of it.
class UiMapFile {
  public:
    explicit UiMapFile(std::filesystem::path file) : file_(std::move(file)) {}
    /// Throws FileError.
    void update(const ItemPlaces& items, const MapState& state, const ItemPlace& window_on_desktop);

  private:
    std::filesystem::path file_;
    std::string written_;
};

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
