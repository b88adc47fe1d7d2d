// What livery_video.so offers: the only code that links OpenCV's video input, which pulls in
// hundreds of shared objects. capture/video_camera.cpp opens it for the first video camera. Only
// plain data crosses this line; an exception never does.
#pragma once

namespace livery {

/// One line, cut when longer.
struct VideoError {
    char text[512] = "";
};

struct VideoFrame {
    int width = 0, height = 0;
    const unsigned char* bgr = nullptr;  ///< until the next call
};

/// Settings by OpenCV's numbers for them.
enum class VideoSetting { exposure, automatic_exposure, gain, frames_per_second, buffered_frames };

struct VideoTable {
    /// A device's number ("0"), a file or an address; null and the reason when it cannot.
    void* (*open)(const char* source, int timeout_ms, VideoError*);
    /// False and the reason when there is no further frame.
    bool (*read)(void* video, VideoFrame*, VideoError*);
    double (*get)(void* video, VideoSetting);
    /// Whether the camera took it; what it made of it, get() tells.
    bool (*set)(void* video, VideoSetting, double value);
    void (*close)(void* video);
};

inline constexpr const char* kVideoTableSymbol = "livery_video_table";

}  // namespace livery
