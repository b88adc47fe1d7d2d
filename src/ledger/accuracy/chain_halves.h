// What half floats make of a picture.
#pragma once

#include <memory>

#include "core/image.h"
#include "core/progress.h"
#include "ledger/accuracy/scenes.h"
#include "radiance/frame_geometry.h"
#include "radiance/lanes/input_layers.h"

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

}  // namespace livery
