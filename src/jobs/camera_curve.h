// The curve of a camera that gives no RAW, kept in the user's folder for the next time.
#pragma once

#include <filesystem>
#include <optional>

#include "capture/camera.h"
#include "core/bench_ports.h"
#include "core/progress.h"

namespace livery {

/// The file of the curve that was fitted for this model; none: none was. Throws CameraFault.
std::optional<std::filesystem::path> kept_camera_curve(Camera& camera);

struct CameraCurve {
    std::filesystem::path file;  ///< a response file (docs/files.md)
    double residual = 0.0;       ///< as CameraResponse
};
/// Shows white at width x height, photographs it at other exposures, fits the curve, keeps it, and
/// reads the camera's 8-bit numbers with it from here on. Throws Refused where the camera gives RAW
/// or its photographs do not follow their exposures, FileError, and what the ports throw; the
/// camera then reads as before.
CameraCurve fit_camera_curve(
    Camera& camera, const BenchPorts& ports, int width, int height, const Progress& progress);

}  // namespace livery
