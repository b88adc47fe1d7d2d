// Still cameras on a cable or a network, through libgphoto2.
#pragma once

#include <chrono>
#include <memory>
#include <string>
#include <vector>

#include "capture/camera.h"
#include "capture/camera_messages.h"

namespace livery {

struct TetheredOptions {
    /// "usb:001,004" as listed, or "ptpip:HOST" or "ptpip:HOST:PORT"; empty: the first that is
    /// found on USB.
    std::string port;
    std::chrono::milliseconds answer{8000};  ///< to everything but a photograph
    /// A photograph, besides its exposure: libgphoto2 itself would wait for ever.
    std::chrono::milliseconds photograph{20000};
};

/// Those on USB; network cameras must be named. Takes a tenth of a second. Throws CameraFault.
std::vector<FoundCamera> list_tethered_cameras();

/// Opens it. Photographs are RAW where the camera is set so (linear, camera colours, half the
/// sensor's resolution each way: one pixel from each square of its colour filter, nothing
/// interpolated), else JPEG, taken for sRGB; each is deleted from the card when it is here. Every
/// call is answered by a process of the camera's own (livery-camera): one that does not
/// answer in time, or breaks off, is ended, and the next call opens the camera anew. Throws
/// CameraFault.
std::unique_ptr<Camera> open_tethered_camera(const TetheredOptions& options);

}  // namespace livery
