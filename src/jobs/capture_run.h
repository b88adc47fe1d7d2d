// A bench photographed with everything kept: what `livery capture` and the window's capture do.
#pragma once

#include <chrono>
#include <functional>

#include "calibration/colour/colour.h"
#include "capture/recording.h"
#include "core/progress.h"

namespace livery {

/// Adds the seconds that a call takes, also where it throws.
template <typename Call>
auto timed(double& seconds, const Call& call) {
    const auto start = std::chrono::steady_clock::now();
    struct Add {
        double& seconds;
        std::chrono::steady_clock::time_point start;
        ~Add() {
            seconds +=
                std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        }
    } add{seconds, start};
    return call();
}

/// Time within the camera's and the projector's ports.
struct PortSeconds {
    double camera = 0.0, projector = 0.0;
};

/// Runs `work` with the bench's ports through the recording. The photograph over which it fails (of
/// another size, automatically exposed) is dropped, so that the next run takes it anew, as are
/// those of pictures that are not known to have arrived (NothingShown); the others stay. The folder
/// has no manifest.json until somebody writes it anew. Throws as `work` and Recording do.
PortSeconds run_recorded(Recording& recording,
                         const BenchPorts& bench,
                         const std::function<void(const BenchPorts&)>& work);

/// calibrate_live() that way. Afterwards the recording is a captures folder with its manifest.json.
/// Throws as calibrate_live() and Recording do, and CameraFault.
LiveResult calibrate_recorded(Recording& recording,
                              const BenchPorts& bench,
                              const LiveOptions& options,
                              const Progress& progress = {});

}  // namespace livery
