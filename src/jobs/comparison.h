// Wanted against shown: CIEDE2000 at every projector pixel with its statistics by kind of pixel;
// and pictures for people: XYZ as sRGB, difference maps, crops.
#pragma once

#include <cstddef>
#include <vector>

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "core/bench_ports.h"
#include "core/image.h"
#include "scene/colour_calibration.h"
#include "twin/bench.h"

namespace livery {

/// Around all non-zero pixels of a mask, `margin_px` wider and inside the picture.
PixelRectangle bounds_of_mask(const Image8& mask, int margin_px);

/// A photograph's linear camera colour through `xyz_from_camera`, for showing it to people.
ImageF developed(const Photograph& photograph, const glm::dmat3& xyz_from_camera);

/// XYZ relative to `white_y` -> 8-bit sRGB, clipped.
Image8 srgb_from_xyz(const ImageF& xyz, double white_y);

/// Working-space colour (1 = white; alpha ignored) -> 8-bit sRGB, clipped: what an uncorrected
/// program would send to the projector.
Image8 srgb_from_working(const ImageF& working);
/// The same into a picture that is kept from frame to frame.
void srgb_from_working_into(const ImageF& working, Image8* srgb);

/// CIEDE2000 from 0 (dark) to `full_scale` (bright) in a perceptually even ramp; NaN is mid grey.
Image8 difference_map(const ImageF& de00, double full_scale);

/// A legend strip for difference_map, left 0 to right full scale.
Image8 difference_legend(int width, int height);

/// Which pixels count, one channel each, 255 or 0, projector pixels.
struct ComparisonMasks {
    Image8 lit;          ///< on the mock-up, by the world's truth
    Image8 edge;         ///< within 2 px of a silhouette, depth or part edge
    Image8 valid;        ///< carries a correction
    Image8 reachable;    ///< some drive shows the wanted colour, by the world's truth
    Image8 predicted{};  ///< of `valid`, those not measured but predicted; empty: none
};

struct ErrorStatistics {
    std::size_t pixels = 0;
    double median = 0.0, p95 = 0.0, mean = 0.0, worst = 0.0;
};

struct Comparison {
    ImageF de00;               ///< one channel; NaN outside the lit mock-up
    ErrorStatistics interior;  ///< lit, reachable, valid, not edge: the figure to quote
    ErrorStatistics edge;      ///< lit, reachable, valid, in the edge band
    ErrorStatistics clipped;   ///< lit, valid, interior, not reachable
    ErrorStatistics
        reachable_with_masked;        ///< interior and reachable, masked ones counted as shown
    ErrorStatistics predicted;        ///< lit, reachable, predicted: interior and edge band
    double reachable_fraction = 0.0;  ///< of the lit pixels
    double valid_fraction = 0.0;      ///< of the interior reachable pixels
    double masked_fraction = 0.0;     ///< of the lit pixels
    double predicted_fraction = 0.0;  ///< of the lit pixels
};

/// Both pictures are XYZ on one absolute scale (3 channels); `white_xyz` is design white there.
/// Throws std::invalid_argument when sizes differ.
Comparison compare_xyz(const ImageF& wanted_xyz,
                       const ImageF& shown_xyz,
                       glm::dvec3 white_xyz,
                       const ComparisonMasks& masks);

/// Median, 95th percentile (nearest rank), mean and worst.
ErrorStatistics statistics_of(std::vector<float> errors);

/// Working-space picture (3 or 4 channels, 1 = design white) -> absolute XYZ (3 channels).
ImageF xyz_from_wanted(const ImageF& wanted_working, double design_white_y);

/// 255 where a calibration corrects (`predicted_only`: where it foretells) a projector pixel.
Image8 corrected_pixels(const ColourCalibration& calibration, bool predicted_only = false);

/// Masks of the eye's picture. What the projector's pixels at an edge light is at an edge too,
/// however wide it looks from the eye. `valid` and `predicted` are of the projector's pixels.
ComparisonMasks masks_of_eye(const Bench& bench,
                             const Image8& valid,
                             const Image8& predicted,
                             const ImageF& wanted_eye_xyz);

/// How far from its place a picture lands that is drawn for a believed view and mesh, in projector
/// pixels, over the mock-up's vertices where `lit` (255). The meshes have the same vertices.
ErrorStatistics picture_offset(const View& true_view,
                               const Mesh& true_mesh,
                               const View& believed_view,
                               const Mesh& believed_mesh,
                               const Image8& lit);

}  // namespace livery
