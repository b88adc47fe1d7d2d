// A bench photographed and calibrated with everything kept: what `livery capture` and the window's
// capture do.
#pragma once

#include "calibration/colour/colour.h"
#include "capture/recording.h"
#include "core/progress.h"

namespace livery {

/// calibrate_live() through the recording. The photograph over which a run fails (of another size,
/// automatically exposed) is dropped, so that the next run takes it anew, as are those of pictures
/// that are not known to have arrived (NothingShown); the others stay. Afterwards the recording is
/// a captures folder with its manifest.json. Throws as calibrate_live() and Recording do, and
/// CameraFault.
LiveResult calibrate_recorded(Recording& recording,
                              const BenchPorts& bench,
                              const LiveOptions& options,
                              const Progress& progress = {});

}  // namespace livery
