// What a projector input shows, and which of the projector's pixels send light: those with a
// correction of their own.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "compensation/compensation.h"
#include "core/image.h"
#include "scene/colour_calibration.h"

namespace livery {

/// The inverse of compensate(): R, G, B in the working space (1: design white), then 1 where the
/// table has a pixel and 0 elsewhere. It knows the projector as the calibration does, levels of 8
/// bits, clipping and gamut mapping included; what the calibration itself is wrong about it cannot
/// know. Throws std::invalid_argument on a wrong size or channel count.
ImageF shown_by(const CompensationTable& table, const Image8& drive);
/// The same of drives between whole levels, 0 to 255 (exact_drive()).
ImageF shown_by(const CompensationTable& table, const ImageF& drive);

/// How much of a wanted picture is shown as it is wanted, by shown_by().
struct PictureReach {
    std::size_t pixels = 0;           ///< covered by half or more, with a correction
    double reachable_fraction = 0.0;  ///< of these, CIEDE2000 under kAsWanted
    double de00_median = 0.0, de00_p95 = 0.0;
};
/// One level of 8 bits is up to 1 in the dark; 2 is seen by few even side by side.
inline constexpr double kAsWanted = 2.0;

/// `wanted_working`: R, G, B, coverage. None of its pixels has a correction: all 0.
PictureReach reach_of(const CompensationTable& table,
                      const ImageF& wanted_working,
                      const Image8& drive);

/// A pixel's surroundings reach this far, in projector pixels: 9x9 of them, weighted from 5 x 5 in
/// the middle to 1 x 1 in the corners. The light of a pixel is a mean over its surroundings, so
/// that of jags up to four pixels deep that repeat within six at most 7% is left.
inline constexpr int kSurroundings_px = 4;

/// A pixel sends all of its light where this share of its surroundings is known; under it light
/// falls in proportion. At a straight border the first unknown pixel is still lit in full, the next
/// three with 72, 36 and 12%; cracks of up to four pixels and holes of 5x5 are closed; a known
/// pixel alone amid unknown ones keeps 12%.
inline constexpr double kKnownEnough = 1.0 / 3.0;

struct LitPixels {
    std::vector<std::uint32_t> pixels;  ///< indices, rising
    std::vector<float> light;  ///< of each: share of the wanted light, linear, over 0 and at most 1
};

/// From what is known alone, so that a calibration of any age gives the same.
LitPixels lit_pixels(const Image8& status);

/// What equation 9 needs of one pixel.
struct PixelCorrection {
    std::array<float, 9> unmixing{};
    std::array<float, 3> dark{}, span{};
};

/// A valid pixel's own numbers; another's are the mean of the valid ones in its surroundings, each
/// weighted by 1 / distance^4: across a silhouette the nearer side decides. Throws
/// std::invalid_argument where a valid pixel's numbers are not finite or its span is not positive.
PixelCorrection correction_of(const ColourCalibration& calibration, std::size_t pixel);

/// What becomes of the pixels that count; the shares add up to 1, or are 0 where none counts.
struct PixelShares {
    double measured = 0.0;      ///< lit in full by a measurement of their own
    double predicted = 0.0;     ///< lit in full, hidden from the camera
    double interpolated = 0.0;  ///< lit in full by their neighbours' correction
    double faded = 0.0;         ///< known or not, lit in part
    double black = 0.0;
};

/// Of `counted` (one channel, non-zero counts; empty: all that the projector lights, as far as the
/// camera sees it, and what is predicted). Throws std::invalid_argument for another size.
PixelShares pixel_shares(const ColourCalibration& calibration, const Image8& counted);

/// "92.7% measured, 0.0% predicted, 5.1% interpolated, 1.2% faded, 1.0% black"
std::string text_of(const PixelShares& shares);

}  // namespace livery
