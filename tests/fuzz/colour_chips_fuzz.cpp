#include <cmath>
#include <stdexcept>

#include "appearance/paint_colour.h"
#include "fuzz/fuzz.h"

LIVERY_FUZZ(text) {
    for (const livery::ColourChip& chip : livery::parse_colour_chips(text, "a.csv")) {
        livery::fuzz::require(!chip.name.empty(), "named");
        livery::fuzz::require(std::isfinite(chip.lab10.x + chip.lab10.y + chip.lab10.z), "finite");
    }
}
