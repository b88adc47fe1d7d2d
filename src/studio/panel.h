// What the window knows of a panel: a value that the panel's own file gives, and one name in the
// list in panels.cpp. Its state is a type of its own in `Studio::panels`.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <typeindex>
#include <vector>

#include "studio/actions.h"
#include "studio/kit/input_queue.h"
#include "studio/kit/ui_map.h"

namespace livery {

struct Notice;
struct Studio;

enum class PanelPlace {
    none,    ///< it adds to the menus, or only hears of the window
    left,    ///< in the left column, one below the other
    tab,     ///< of the right column
    column,  ///< instead of the tabs, the first that is open
    page,    ///< over everything
};

/// All but the name may be missing. A panel's file ends with its own: Panel seats_panel() { ... }
struct Panel {
    const char* name;  ///< "seats": neither language nor layout change it; of a tab, its title
    PanelPlace place = PanelPlace::none;
    /// Once a frame of the window: inside its region; of a page always, whether open or not.
    void (*draw)(Studio& studio) = nullptr;
    /// Instead of the stage; false: the stage is drawn.
    bool (*draw_stage)(Studio& studio) = nullptr;
    bool (*is_open)(const Studio& studio) = nullptr;  ///< of columns and pages
    void (*show)(Studio& studio, bool shown) = nullptr;

    void (*start)(Studio& studio) = nullptr;  ///< once, when the window's threads run
    void (*step)(Studio& studio) = nullptr;   ///< once a frame of the window, before it is drawn
    /// Before the threads end, with the window's context current.
    void (*stop)(Studio& studio) = nullptr;
    /// What a key means now that nobody types; passed_on: nothing here.
    EventUse (*press)(Studio& studio, const KeyChord& chord, bool repeated) = nullptr;
    bool esc_closes = false;
    /// What else Esc gives up: true when there was something. Pages and tabs are asked before what
    /// is being tried is taken back, the others after it.
    bool (*give_up)(Studio& studio) = nullptr;
    /// When it changes by itself, `now_s` of the studio; 0: something else will wake the window.
    double (*next_change_s)(const Studio& studio) = nullptr;

    /// Why nothing may be edited now, for the operator; none: it may.
    std::optional<Notice> (*locks_editing)(const Studio& studio) = nullptr;
    /// How many letters, from A, are designs' now.
    std::size_t (*letters)(const Studio& studio) = nullptr;
    /// The mock-up's picture is to stay as it is: it is not refined.
    bool (*holds_picture)(const Studio& studio) = nullptr;

    /// For `--ui-map`.
    void (*describe)(const Studio& studio, MapState& state) = nullptr;
    /// In its menus' order.
    std::vector<Action> (*actions)() = nullptr;
};

/// How soon progress that is read, not told, is looked at again, seconds.
inline constexpr double kProgress_s = 0.25;

/// In the order of their drawing, of their steps and of their menu entries.
const std::vector<Panel>& all_panels();
/// Throws std::invalid_argument for a name that is not there.
const Panel& panel_named(std::string_view name);

bool is_open(const Studio& studio, std::string_view name);
void show_panel(Studio& studio, std::string_view name, bool shown = true);
/// How many letters, from A, are designs' now.
std::size_t letters_taken(const Studio& studio);
/// The entry of a menu that opens and closes a panel.
Action panel_action(const char* id, const char* panel, const char* menu, const char* label);

/// What panels remember from one frame of the window to the next, each in a type of its own;
/// nothing of it is part of the session. Made when it is first asked for. Owns textures: to be
/// cleared with the window's context current.
class PanelStates {
  public:
    template <typename State>
    State& of() const {
        std::shared_ptr<void>& state = states_[typeid(State)];
        if (!state) state = std::make_shared<State>();
        return *static_cast<State*>(state.get());
    }
    void clear() { states_.clear(); }

  private:
    mutable std::map<std::type_index, std::shared_ptr<void>> states_;
};

}  // namespace livery
