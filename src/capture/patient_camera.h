// A camera that may go and come back in the middle of a capture.
#pragma once

#include "capture/camera.h"
#include "core/progress.h"

namespace livery {

/// The camera as a port. What somebody can put right in place (cable, power, another program, a
/// full card) is told to `on_wait` and tried again until it works, then told once more, or until a
/// stop is asked for (Cancelled). Other faults are thrown. `camera` must outlive the port.
TakePhotograph patient(Camera& camera, const Progress& progress, TellWait on_wait);

}  // namespace livery
