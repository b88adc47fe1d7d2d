// A list of paints to choose one from: found by typing, shown as swatches with their names.
#pragma once

#include <functional>
#include <string>

#include "studio/studio.h"

namespace livery {

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
