// Pictures of paints on a sphere, drawn by the preview's thread when it has time; one paint's cell
// in a list; and a list of paints to choose one from.
#pragma once

#include <imgui.h>

#include "core/image.h"
#include "studio/studio.h"

struct ImVec2;

namespace livery {

/// Where the preview's thread leaves swatches. Shared, because a swatch may be finished after the
/// panel that asked for it is gone.
class SwatchInbox {
  public:
    void put(const std::string& key, const Image8& picture);  ///< and wakes the window
    std::map<std::string, Image8> take();

  private:
    std::mutex mutex_;
    std::map<std::string, Image8> drawn_;  ///< by the paint's parameters
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

/// The session's own, else the library's; null for a file, and for one that is gone.
const Material* paint_named(Studio& studio, const std::string& name);

/// In an open list: what the search finds, named "PREFIX:PAINT". `offer` is called right after each
/// item, told whether it was picked.
void draw_paint_list(Studio& studio,
                     const std::string& search,
                     const std::string& prefix,
                     const std::string& chosen,
                     const std::function<void(const Material& paint, bool picked)>& offer);

/// A list's row: a swatch (none: an empty place) and a text; true when it was picked.
bool swatch_row(Studio& studio, const Material* paint, const std::string& text, bool chosen);

}  // namespace livery
