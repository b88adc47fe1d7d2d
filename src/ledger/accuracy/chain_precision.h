// What half floats make of a picture, and what cutting drives to whole levels does.
#pragma once

#include <memory>
#include <vector>

#include "compensation/compensation.h"
#include "core/image.h"
#include "core/progress.h"
#include "ledger/accuracy/scenes.h"
#include "radiance/lanes/input_layers.h"
#include "radiance/renderer.h"

namespace livery {

struct StoredPicture {
    ImageF working;        ///< R, G, B, coverage
    double swap_ms = 0.0;  ///< all parts shaded and mixed anew
};

/// A scene in normal quality, drawn by OpenGL, which is current, with what `halves` says in half
/// floats and the rest in full ones.
StoredPicture stored_picture(const AccuracyScene& scene,
                             const std::shared_ptr<const FrameGeometry>& geometry,
                             StoredHalves halves,
                             const Progress& progress = {});

/// Drives, 0 to 255, to the nearest whole level, without dither.
Image8 rounded_drive(const ImageF& exact);

/// CIEDE2000 between what a drive and the exact one show by the calibration's own model
/// (shown_by()), light averaged over squares of `side_px` pixels that all have a correction: an eye
/// that is far away sees no less than that.
std::vector<float> drive_errors(const CompensationTable& table,
                                const Image8& drive,
                                const ImageF& exact,
                                int side_px);

/// Of correcting a frame on the processor, the median of several.
double compensation_ms(const CompensationTable& table, const ImageF& wanted_working);

}  // namespace livery
