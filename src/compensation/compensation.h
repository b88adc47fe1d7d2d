// (2) radiance + calibration -> projector input: equation 9 of the paper at every pixel.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "core/image.h"
#include "scene/colour_calibration.h"
#include "scene/gamut_mapping.h"

namespace livery {

/// The brightest D65 neutral (as Y in the calibration's XYZ) that at least (100 - percentile)% of
/// the valid pixels of `mockup` (one channel, non-zero: counts; empty: all) can show. The projector
/// also lights the table, and a dark table must not dim the mock-up: pass what is known of the
/// mock-up (scene/mockup_mask.h). Throws std::invalid_argument on a wrong size or percentile,
/// Refused when no pixel counts.
double design_white_luminance(const ColourCalibration& calibration,
                              double percentile,
                              const Image8& mockup);

/// N(drive) of a non-additive projector and a start for its inverse. "Linear" is rho^-1(drive) per
/// channel, in which N bends least: between nodes N is linear in it, by tetrahedra.
struct NonAdditive {
    int grid = 0;                           ///< 0: the projector is additive, the rest is empty
    std::vector<glm::vec3> n_from_nodes;    ///< grid^3, red fastest
    std::array<std::vector<float>, 3> rho;  ///< drive, equally spaced linear
    std::array<std::vector<float>, 3> linear_of_node;  ///< rising from 0 to 1
    int start_grid = 0;
    std::vector<glm::vec3> start;  ///< nearest node number, fractional, for rho(N); red fastest
};

/// Where the colours end that GamutMapping::preserve moves the wanted ones into (constant hue in
/// Oklab, soft knees, chroma before lightness). It depends on the calibration alone, so looks that
/// are compared share it. Planes have one value for each of the table's pixels; lightness is
/// Oklab's, of neutrals, 0 and 0 where none can be shown.
struct GamutBoundary {
    std::vector<float> coefficients;        ///< 12 planes as in the table, of the neighbourhood
    std::vector<float> darkest, brightest;  ///< of the neighbourhood, over the floor
    std::vector<float> own_darkest, own_brightest;  ///< of the pixel
    double floor_lightness = 0.0;  ///< the one black that all share: 95% of them can show it
};

/// The calibration baked for one design white: N = light * (A * rgb + b) per lit pixel, packed
/// densely. Lit are the valid pixels and, faded to black, those around them (lit_pixels.h).
struct CompensationTable {
    int width = 0, height = 0;
    double design_white_y = 0.0;
    std::vector<std::uint32_t> pixels;  ///< index of each lit pixel, rising
    std::vector<float> light;           ///< of each: share of the wanted light, over 0, at most 1
    std::vector<float> coefficients;  ///< 12 planes of pixels.size(): light * A by rows, light * b
    std::array<std::vector<float>, 3> drive_from_n;  ///< equally spaced in N; empty if non-additive
    NonAdditive non_additive;
    GamutBoundary gamut;  ///< empty: what cannot be shown is clipped (GamutMapping::strict)
    std::string calibration_id;
};

/// Wanted colours are in the working space, 1 = design white. Throws std::invalid_argument on
/// planes of different sizes, an empty or falling response, a singular xyz_from_camera, and a
/// pixel marked valid whose numbers are not finite or whose span is not positive.
CompensationTable bake(const ColourCalibration& calibration,
                       double design_white_y,
                       GamutMapping gamut = GamutMapping::strict);

/// Of what was wanted, before any gamut mapping; at a faded pixel of what is left of it.
struct CompensationStats {
    double out_of_gamut_fraction = 0.0;  ///< of the lit pixels with a wanted colour
    double invalid_fraction = 0.0;  ///< of the pixels with a wanted colour: black; NaN, Inf too
    double clipped_high_fraction = 0.0;  ///< of the lit ones: too bright in some channel
    double clipped_low_fraction = 0.0;   ///< of the lit ones: under the black level in some
};

/// On all threads, which change no bit of it; the GPU pass's oracle. `wanted` holds R, G, B
/// (working space) and, if there is a fourth channel, coverage: pixels covered by less than half
/// are black, as are those that are not lit. Colours out of gamut are moved as the table was baked
/// for. NaN, Inf never propagate. Dither is fixed by pixel position. Throws std::invalid_argument
/// on a wrong size or channel count.
Image8 compensate(const CompensationTable& table,
                  const ImageF& wanted_working,
                  CompensationStats* stats = nullptr);

/// The same into a picture that is kept from frame to frame: no page of it is new.
void compensate_into(const CompensationTable& table,
                     const ImageF& wanted_working,
                     Image8* drive,
                     CompensationStats* stats = nullptr);

/// Pixels that `wanted` covers by half or more, all without a coverage channel.
std::size_t count_covered(const ImageF& wanted_working);

/// compensate_into() for a show: what it costs depends on the table's pixels, not on the picture's.
/// `drive` is empty or holds what this function made of the same table; `covered_pixels` is
/// count_covered(), which a mock-up that stands still need not count again.
void compensate_again(const CompensationTable& table,
                      const ImageF& wanted_working,
                      std::size_t covered_pixels,
                      Image8* drive,
                      CompensationStats* stats = nullptr);

/// The fixed dither of pixel (x, y), the same for its three channels, in [-0.5, 0.5) drive levels;
/// shaders/ has the same.
float dither_of(std::uint32_t x, std::uint32_t y);

}  // namespace livery
