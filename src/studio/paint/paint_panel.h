// What the paint panel remembers between frames.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "studio/kit/widgets.h"
#include "studio/paint/paint_portrait.h"
#include "studio/paint/paint_rows.h"

namespace livery {

struct PaintPanelState {
    PaintPortraitState portrait;
    PaintColourState colour;
    Held<Material> held;
    bool brushed = false;  ///< along and across are shown although they are equal
    // What the panel shows, looked up again when one of these changes.
    bool read = false;
    std::uint64_t revision = 0;
    int look = -1, part = -1;
    std::string part_name;             ///< empty: none is chosen
    std::optional<Material> material;  ///< none: the product file's own colour
    std::optional<Material> in_model;  ///< `in_model_of` in the model that was pointed at last
    Material in_model_of;
    std::string problem;
    std::string becomes;  ///< the name that the first change gives
    // "Save as new paint"
    std::string new_name, new_family, save_problem;
    // "Rename"
    std::string other_name, rename_problem;
};

}  // namespace livery
