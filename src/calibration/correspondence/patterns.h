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

/// Throws std::invalid_argument for a projector smaller than 2 or larger than 16384 pixels a side.
void check_pattern_size(int width, int height);

/// Bits of the Gray code that numbers `count` columns or rows.
int gray_code_bits(int count);

/// The roles of geometry_patterns(), in their order.
std::vector<std::string> geometry_roles(int width, int height);

/// Gray code both ways, each bit (0 the most significant) followed by its inverse, then white,
/// black. Throws std::invalid_argument for sizes outside 2..16384.
std::vector<Pattern> geometry_patterns(int width, int height);
/// One of them: all together are a gigabyte for a projector of 8 megapixels.
Pattern geometry_pattern(int width, int height, std::size_t number);

/// The six pictures of the method for drives s and t: dark-gray, bright-gray, red, green, blue,
/// gray-levels. The blocks of gray-levels are squares of 8 to 16 px; of every 16 x 16, a quarter
/// are black (what these show is light from elsewhere), sixteen white, and the rest hold levels
/// between, the denser the darker. Which is where is shuffled, so that all have neighbours alike.
std::vector<Pattern> colour_patterns(int width, int height, int dark_drive, int bright_drive);

/// Mosaics that are shown: with the six pictures of the method twelve.
inline constexpr int kMosaics = 6;

/// Mosaics of colours for projectors that are not additive, `count` pictures: ramps of one
/// channel, of two and three equal channels, and colours spread evenly over the cube.
std::vector<Pattern> mosaic_patterns(int width, int height, int count);

}  // namespace livery
