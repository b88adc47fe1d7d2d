// A camera that may go and come back in the middle of a capture.
#pragma once

#include <functional>
#include <string>

#include "capture/camera.h"
#include "core/progress.h"

namespace livery {

/// What a capture waits for; empty `why`: for nothing any more.
struct CameraWait {
    std::string why, fix;
};

/// The camera as a port. What somebody can put right in place (cable, power, another program, a
/// full card) is told to `on_wait` and tried again until it works, then told once more, or until a
/// stop is asked for (Cancelled). Other faults are thrown. `camera` must outlive the port.
TakePhotograph patient(Camera& camera,
                       const Progress& progress,
                       std::function<void(const CameraWait&)> on_wait);

}  // namespace livery
