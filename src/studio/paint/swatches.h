// Pictures of paints on a sphere, drawn by the preview's thread when it has time, and one paint of
// the library's grid.
#pragma once

#include <map>
#include <mutex>
#include <string>

#include <imgui.h>

#include "core/image.h"
#include "studio/studio.h"

struct ImVec2;

namespace livery {

/// Where the preview's thread leaves swatches. Shared, because a swatch may be finished after the
/// panel that asked for it is gone.
struct SwatchInbox {
    std::mutex mutex;
    std::map<std::string, Image8> drawn;  ///< by the paint's parameters
};

/// Once a frame of the window: turns what has arrived into textures.
void take_swatches(Studio& studio);

/// Draws the sphere into the current window; asks for it, and draws a plain disc of its colour,
/// while there is none.
void draw_swatch(Studio& studio, const Material& material, const ImVec2& corner, float side_px);

/// The swatch with the paint's name under it, over the last item, whose upper left is `corner`;
/// `distance` from a colour that was searched for, empty: none was.
void draw_swatch_cell(Studio& studio,
                      const Material& paint,
                      const std::string& distance,
                      const ImVec2& corner,
                      float width,
                      bool worn,
                      bool lit);
/// What the paint is and where it comes from, beside the window that is drawn.
void paint_tooltip(const Material& paint);

}  // namespace livery
