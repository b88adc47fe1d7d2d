// The pictures that a calibration projects, each with its role (docs/files.md lists the roles).
#pragma once

#include <string>
#include <vector>

#include "core/image.h"

namespace livery {

struct Pattern {
    std::string role;  ///< "gray-column-0", "white", "dark-gray", "red", "gray-levels", ...
    Image8 drive;      ///< RGB at the projector's resolution
    std::vector<int> drive_values;  ///< of a uniform picture: R, G, B; else empty
};

/// Gray code both ways, each bit (0 the most significant) followed by its inverse, then white, black.
std::vector<Pattern> geometry_patterns(int width, int height);

/// The six pictures of the method for drives s and t: dark-gray, bright-gray, red, green, blue,
/// gray-levels (blocks of at least 8 px).
std::vector<Pattern> colour_patterns(int width, int height, int dark_drive, int bright_drive);

/// Mosaics of colours for projectors that are not additive, `count` pictures.
std::vector<Pattern> mosaic_patterns(int width, int height, int count);

}  // namespace livery
