// The chosen paint in another colour: typed, or one of a file of colour chips.
#pragma once

#include "studio/studio.h"

namespace livery {

/// Two rows. Tries the colour on the mock-up while it is typed or pointed at; `paint` is what the
/// panel shows.
void draw_paint_colour_row(Studio& studio, const Material& paint);

}  // namespace livery
