// Still cameras on a cable or a network, through libgphoto2.
#pragma once

#include <chrono>
#include <memory>
#include <string>
#include <vector>

#include "capture/camera.h"

namespace livery {

struct TetheredOptions {
    /// "usb:001,004" as listed, or "ptpip:HOST" or "ptpip:HOST:PORT"; empty: the first that is
    /// found on USB.
    std::string port;
    std::chrono::milliseconds answer{8000};  ///< to everything but a photograph
    /// A photograph, besides its exposure: libgphoto2 itself would wait for ever.
    std::chrono::milliseconds photograph{20000};
};

struct FoundCamera {
    std::string model, port;
    std::string held_by;  ///< programs that have it open, with their numbers; empty: nobody
};
/// Those on USB; network cameras must be named. Takes a tenth of a second. Throws CameraFault.
std::vector<FoundCamera> list_tethered_cameras();

/// Opens it. Photographs are RAW where the camera is set so (linear, camera colours, half the
/// sensor's resolution each way: one pixel from each square of its colour filter, nothing
/// interpolated), else JPEG, taken for sRGB; each is deleted from the card when it is here. Every
/// call runs on a thread of the camera's own: one that does not answer in time is given up, thread
/// and all, and the next call opens the camera anew. Throws CameraFault.
std::unique_ptr<Camera> open_tethered_camera(const TetheredOptions& options);

/// Seconds of a shutter speed as cameras write it: "1/60", "0.1000s", "0.4", "2\"". Negative:
/// "bulb", "auto" and what else is no time.
double seconds_of_shutter_speed(const std::string& text);

}  // namespace livery
