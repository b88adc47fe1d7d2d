// A simulated bench calibrated through its three ports, as the demo and the desktop do it.
#pragma once

#include "calibration/colour/colour.h"
#include "core/image.h"
#include "core/progress.h"
#include "scene/colour_calibration.h"
#include "scene/product.h"
#include "twin/bench.h"

namespace livery {

struct BenchCalibration {
    ColourCalibration calibration;  ///< with what the camera does not see predicted from the pose
    LiveResult live;                ///< its own calibration is moved out
    ImageF geometry;                ///< projector_irradiance() of the bench's pose
    double predict_seconds = 0.0;
};

/// Shows the patterns on the bench, photographs them, solves, and predicts from the bench file's
/// pose. Throws Refused, Cancelled.
BenchCalibration calibrate_through_ports(Bench& bench,
                                         const Product& product,
                                         const Progress& progress);

}  // namespace livery
