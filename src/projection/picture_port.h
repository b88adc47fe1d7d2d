// Pictures of a calibration onto the projector, each waited for.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>

#include "core/bench_ports.h"
#include "core/image.h"
#include "core/progress.h"
#include "projection/projector_screen.h"

namespace livery {

/// Device values, RGB, as a picture for the projector: uploaded in the current context.
std::shared_ptr<const ProjectorPicture> projector_picture(const Image8& rgb, std::uint64_t number);

/// Above all frames' numbers, and no two alike: for pictures that are shown instead of frames. Any
/// thread.
std::uint64_t next_picture_number();

/// How a capture reaches the projector; all of it from any thread.
struct ProjectorAccess {
    std::function<void(std::shared_ptr<const ProjectorPicture>)> present;
    std::function<ShownPicture()> shown;
};

/// The projector as a port, for a thread that has a context of its share group current. Returns
/// when the picture was swapped in and two refreshes of a projector have passed. While it does not
/// appear (cable pulled, black, frozen) `on_wait` is told and it is waited for, until a stop is
/// asked for (Cancelled).
ShowPicture show_on(ProjectorAccess projector, const Progress& progress, TellWait on_wait);

}  // namespace livery
