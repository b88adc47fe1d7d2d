// One paint of the library's grid.
#pragma once

#include <string>

#include <imgui.h>

#include "studio/studio.h"

namespace livery {

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
