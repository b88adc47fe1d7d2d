// Video and network cameras: frames averaged to a photograph.
#pragma once

#include <memory>
#include <string>

#include "capture/camera.h"

namespace livery {

struct VideoCameraOptions {
    /// A device's number ("0" is /dev/video0), a video file, or the address of a stream
    /// ("http://camera/video.mjpg", "rtsp://...").
    std::string source;
    int frames = 8;           ///< averaged to a photograph: eight quantise a third as coarsely
    int settling_frames = 4;  ///< thrown away after the exposure was changed
    int timeout_ms = 4000;
    /// What a photograph says of its exposure where the camera cannot be asked: a stream's exposure
    /// is fixed in the camera itself, and only ratios count.
    double nominal_exposure_s = 1.0 / 30.0;
};

/// Exposure is set by hand and automatic gain switched off where the camera allows it; else
/// `state()` warns. A photograph is the mean of frames in a row that show one picture and began
/// after it was asked for: what is still on its way is passed over, of a file the next frames are
/// taken. Throws CameraFault.
std::unique_ptr<Camera> open_video_camera(const VideoCameraOptions& options);

}  // namespace livery
