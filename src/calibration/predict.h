// Pixels that the projector lights and the camera does not see: filled in from the pose.
#pragma once

#include "core/image.h"
#include "scene/colour_calibration.h"

namespace livery {

/// The same calibration with the hidden pixels predicted and marked; not sealed yet. `geometry`
/// (one channel, projector pixels) is the irradiance that each pixel's surface receives, on any
/// scale: cos(theta) / distance^2; 0 where less than half of the pixel lies on the mock-up.
///
/// Filled are pixels without a measurement of their own (unlit, not decoded, edge, too dark). What
/// the camera did measure and had to reject (saturated, one channel, ill-conditioned) stays as it
/// is. A pixel's span is its geometry times the median of span / geometry over the measured pixels
/// around it, which follows vignetting; its dark the median there; its unmixing the median of all.
/// Pixels under kGrazingShare of the brightest geometry are left.
///
/// The measured pixels are predicted too, each without its surroundings: `prediction_error_median`
/// and `prediction_error_p95`. Nothing is predicted, and a warning says so, where the mock-up is
/// not neutral, hardly any measured pixel lies on the mesh, or the errors show another pose or
/// mesh.
///
/// Throws std::invalid_argument for a geometry of another size, negative or not finite.
ColourCalibration predict_hidden(ColourCalibration calibration, const ImageF& geometry);

/// At 5% of full irradiance light falls 2.9 degrees from grazing: a normal that is half a degree
/// off there changes it by 17%, and what such pixels can show is nearly black.
inline constexpr double kGrazingShare = 0.05;

/// Largest median error of the measured pixels' prediction with which pixels are still predicted.
inline constexpr double kPredictionLimit = 0.10;

}  // namespace livery
