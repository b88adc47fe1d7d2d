#include "capture/video_module.h"

#include <algorithm>
#include <cstring>
#include <exception>
#include <memory>
#include <string>
#include <vector>

#include <opencv2/core/utils/logger.hpp>
#include <opencv2/videoio.hpp>

namespace livery {

namespace {

struct OpenedVideo {
    cv::VideoCapture capture;
    cv::Mat frame;
};

void say(VideoError* error, const char* text) {
    std::strncpy(error->text, text, sizeof(error->text) - 1);
    std::replace(error->text, error->text + std::strlen(error->text), '\n', ' ');
}

int property(VideoSetting setting) {
    switch (setting) {
        case VideoSetting::exposure:
            return cv::CAP_PROP_EXPOSURE;
        case VideoSetting::automatic_exposure:
            return cv::CAP_PROP_AUTO_EXPOSURE;
        case VideoSetting::gain:
            return cv::CAP_PROP_GAIN;
        case VideoSetting::frames_per_second:
            return cv::CAP_PROP_FPS;
        case VideoSetting::buffered_frames:
            return cv::CAP_PROP_BUFFERSIZE;
    }
    return -1;
}

bool is_number(const std::string& text) {
    return !text.empty() && text.size() < 4 &&
           std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
}

void* open(const char* source, int timeout_ms, VideoError* error) try {
    cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT);
    auto video = std::make_unique<OpenedVideo>();
    const std::string text(source);
    if (is_number(text)) {
        video->capture.open(std::stoi(text), cv::CAP_V4L2);
    } else {
        video->capture.open(text,
                            cv::CAP_FFMPEG,
                            std::vector<int>{cv::CAP_PROP_OPEN_TIMEOUT_MSEC,
                                             timeout_ms,
                                             cv::CAP_PROP_READ_TIMEOUT_MSEC,
                                             timeout_ms});
    }
    if (!video->capture.isOpened()) {
        say(error, "nothing that can be opened as a video");
        return nullptr;
    }
    return video.release();
} catch (const std::exception& failure) {
    say(error, failure.what());
    return nullptr;
}

bool read(void* opaque, VideoFrame* frame, VideoError* error) try {
    OpenedVideo& video = *static_cast<OpenedVideo*>(opaque);
    if (!video.capture.read(video.frame) || video.frame.empty()) {
        say(error, "no further frame");
        return false;
    }
    if (video.frame.type() != CV_8UC3 || !video.frame.isContinuous()) {
        say(error, "frames that are not 8-bit colour");
        return false;
    }
    *frame = {video.frame.cols, video.frame.rows, video.frame.data};
    return true;
} catch (const std::exception& failure) {
    say(error, failure.what());
    return false;
}

double get(void* opaque, VideoSetting setting) try {
    return static_cast<OpenedVideo*>(opaque)->capture.get(property(setting));
} catch (const std::exception&) {
    return -1.0;
}

bool set(void* opaque, VideoSetting setting, double value) try {
    return static_cast<OpenedVideo*>(opaque)->capture.set(property(setting), value);
} catch (const std::exception&) {
    return false;
}

void close(void* opaque) try {
    delete static_cast<OpenedVideo*>(opaque);
} catch (const std::exception&) {
    // The camera is gone; there is nothing to close.
}

}  // namespace

}  // namespace livery

extern "C" __attribute__((visibility("default"))) const livery::VideoTable* livery_video_table();

const livery::VideoTable* livery_video_table() {
    static constexpr livery::VideoTable table{
        livery::open, livery::read, livery::get, livery::set, livery::close};
    return &table;
}
