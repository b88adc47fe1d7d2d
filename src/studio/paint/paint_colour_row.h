// The chosen paint in another colour: typed, or one of a file of colour chips.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "appearance/fit/recolour.h"
#include "appearance/paint_colour.h"
#include "studio/studio.h"

namespace livery {

struct PaintColourState {
    std::string text;  ///< in the field
    bool typing = false, edited = false;
    std::vector<ColourChip> chips;
    std::string chips_file;
    std::optional<Recoloured> made;  ///< the last that was worked out
    std::vector<double> made_of;     ///< of that paint in that colour
};

/// Two rows. Tries the colour on the mock-up while it is typed or pointed at; `paint` is what the
/// panel shows.
void draw_paint_colour_row(Studio& studio, const Material& paint);

}  // namespace livery
