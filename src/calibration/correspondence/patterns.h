// The pictures that a calibration projects, each with its role (docs/files.md lists the roles);
// sinusoidal fringes among them, which place a camera pixel within a projector pixel.
#pragma once

#include <filesystem>
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

/// Projector pixels a period. Noise moves a place by period / 2 pi * sqrt(2 / shifts) * noise /
/// amplitude, so that short periods are exact; a blur of 4 px still leaves 29% of the amplitude at
/// 16 px and nothing at 8, and the Gray code may be off by just under half a period.
inline constexpr int kFringePeriod_px = 16;

/// Shifts of a fifth of a period. N shifts see no harmonics but k N +- 1: the third, which a
/// response that is not known yet makes (gamma 2.6: 3.7% of the first), moves a place by .09 px
/// with four shifts; with five nothing moves it by more than .05 px at gamma 1 to 2.6, sRGB and an
/// S-shaped response (tests/calibration/fringes_test.cpp prints all), and more shifts gain little.
inline constexpr int kFringeShifts = 5;

/// Drives between which fringes swing: where a projector stretches video levels, what lies outside
/// is cut off, and clipped sinusoids have harmonics that no number of shifts here takes out.
inline constexpr int kFringeDarkest = 16, kFringeBrightest = 235;

/// Drive of fringe `shift` at a projector pixel's centre `place_px` along its axis, before it is
/// rounded.
double fringe_drive(double place_px, int shift);

/// Whether a role is that of a fringe: phase-...
bool is_fringe_role(const std::string& role);

/// phase-column-0 to -4, phase-row-0 to -4.
std::vector<std::string> fringe_roles();

/// The fringe of that number among fringe_roles(). Throws std::invalid_argument for another number
/// and for sizes outside 2..16384.
Pattern fringe_pattern(int width, int height, std::size_t number);

/// What is shown to find where the camera sees each projector pixel.
enum class PlaceCode {
    gray,           ///< whole projector pixels
    gray_and_phase  ///< parts of them; ten pictures more
};

/// The roles and pictures of a code, in the order in which they are shown: geometry_patterns(),
/// then the fringes.
std::vector<std::string> place_roles(PlaceCode code, int width, int height);
Pattern place_pattern(PlaceCode code, int width, int height, std::size_t number);
std::vector<Pattern> place_patterns(PlaceCode code, int width, int height);

/// Whether `roles`, those of photographs in `source`, hold fringes. Throws FileError where they
/// hold some and lack one, or hold a shift that there is not. Other roles are ignored.
bool check_fringes(const std::filesystem::path& source, const std::vector<std::string>& roles);

}  // namespace livery
