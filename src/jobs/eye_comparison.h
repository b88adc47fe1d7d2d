// What the audience of a bench sees against what it should see, in the eye's picture.
#pragma once

#include "jobs/comparison.h"
#include "scene/colour_calibration.h"
#include "twin/bench.h"

namespace livery {

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
