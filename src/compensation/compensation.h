// (2) radiance + calibration -> projector input: equation 9 of the paper at every pixel.
#pragma once

#include <cstdint>
#include <vector>

#include "core/image.h"
#include "scene/colour_calibration.h"

namespace livery {

/// The brightest D65 neutral (as Y in the calibration's XYZ) that at least (100 - percentile)% of
/// the valid pixels of `parts_mask` (one channel, non-zero: counts; empty: all) can show.
double design_white_luminance(const ColourCalibration& calibration,
                              double percentile,
                              const Image8& parts_mask = {});

/// The calibration baked for one design white: N = A * rgb + b per valid pixel, packed densely.
struct CompensationTable {
    int width = 0, height = 0;
    double design_white_y = 0.0;
    std::vector<std::uint32_t> pixels;  ///< index of each valid pixel, rising
    std::vector<float> coefficients;    ///< 12 planes of pixels.size(): A row by row, then b
    std::array<std::vector<float>, 3> drive_from_n;  ///< equally spaced in N, see ResponseCurve
    DriveTable table;                                ///< non-additive projectors
    std::string calibration_id;
};

/// Wanted colours are in the working space, 1 = design white.
CompensationTable bake(const ColourCalibration& calibration, double design_white_y);

struct CompensationStats {
    double out_of_gamut_fraction = 0.0;  ///< of the valid pixels with a wanted colour
    double invalid_fraction = 0.0;       ///< of the pixels with a wanted colour
    double clipped_high_fraction = 0.0;
    double clipped_low_fraction = 0.0;
};

/// CPU oracle, one thread. `wanted` holds R, G, B (working space) and, if there is a fourth
/// channel, coverage: pixels covered by less than half are black, as are invalid ones. NaN, Inf
/// never propagate. Dither is fixed by pixel position.
Image8 compensate(const CompensationTable& table,
                  const ImageF& wanted_working,
                  CompensationStats* stats = nullptr);

enum class GamutMapping { strict, preserve };

/// Moves wanted colours into what each pixel can show (constant hue in Oklab, soft knee, chroma
/// before lightness); strict returns them as they are (compensate clips).
ImageF map_gamut(const CompensationTable& table, const ImageF& wanted_working, GamutMapping mapping);

/// The fixed dither of pixel (x, y), channel c, in [-0.5, 0.5) drive levels; shaders/ has the same.
float dither_of(std::uint32_t x, std::uint32_t y, std::uint32_t channel);

}  // namespace livery
