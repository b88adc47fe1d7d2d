// What the paint library panel remembers between frames. Owns textures: destroyed with the window's
// context current.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>

#include "gl/handles.h"
#include "studio/paint/swatches.h"

namespace livery {

struct LibraryPanelState {
    std::string search;
    bool searching = false;             ///< the text cursor is in the search
    bool focus_search = false;          ///< set by a key: the next frame puts the text cursor there
    std::string family;                 ///< empty: all
    std::optional<std::string> cursor;  ///< the paint that the arrow keys are on
    bool cursor_moved = false;          ///< it must be scrolled to
    int cursor_rows = 0;                ///< up or down, pressed in the search in this frame
    bool owns_arrows = false;           ///< the swatches have the keyboard
    std::shared_ptr<SwatchInbox> inbox = std::make_shared<SwatchInbox>();
    std::map<std::string, Texture2D> swatches;
    std::set<std::string> asked;
};

}  // namespace livery
