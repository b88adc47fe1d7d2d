#include "capture/video_camera.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <deque>
#include <filesystem>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <thread>
#include <utility>

#include <fmt/format.h>

#include "capture/transfer.h"
#include "capture/video_module.h"
#include "core/system/module.h"

namespace livery {

namespace {

using Clock = std::chrono::steady_clock;

// V4L2 counts exposures in tenths of a millisecond; 1 is "manual" there.
constexpr double kExposureUnit_s = 1e-4, kManual = 1.0;
constexpr int kMostRestarts = 4;  // Whoever walks about in front of the camera must not hold it up.

const VideoTable& module_table() {
    static const VideoTable& table = *reinterpret_cast<const VideoTable* (*)()>(
        symbol_of_module("livery_video.so", kVideoTableSymbol, "Livery's video input"))();
    return table;
}

/// A source that is open.
class Video {
  public:
    Video(const std::string& source, int timeout_ms) : table_(module_table()) {
        VideoError error;
        video_ = table_.open(source.c_str(), timeout_ms, &error);
        if (!video_) {
            throw CameraFault(CameraTrouble::gone,
                              "video " + source + " does not open: " + error.text,
                              "check the cable or the address, and that no other program has it");
        }
    }
    ~Video() { table_.close(video_); }
    Video(const Video&) = delete;
    Video& operator=(const Video&) = delete;

    std::optional<VideoFrame> read() {
        VideoFrame frame;
        if (!table_.read(video_, &frame, &error_)) return std::nullopt;
        return frame;
    }
    const char* problem() const { return error_.text; }
    double get(VideoSetting setting) { return table_.get(video_, setting); }
    bool set(VideoSetting setting, double value) { return table_.set(video_, setting, value); }

  private:
    const VideoTable& table_;
    void* video_;
    VideoError error_;
};

bool is_device(const std::string& source) {
    return !source.empty() && source.size() < 4 &&
           std::all_of(source.begin(), source.end(), [](char c) { return c >= '0' && c <= '9'; });
}

bool is_file(const std::string& source) {
    std::error_code error;
    return source.find("://") == std::string::npos && !is_device(source) &&
           std::filesystem::is_regular_file(source, error);
}

/// Whether a thousandth of the pixels differ by more than any camera's noise: another picture.
bool shows_another(const Image8& before, const Image8& now) {
    if (before.values.size() != now.values.size()) return false;
    constexpr int kBeyondNoise = 16;
    std::size_t differing = 0, looked_at = 0;
    for (std::size_t k = 0; k < now.values.size(); k += 7, ++looked_at)
        differing += std::abs(static_cast<int>(now.values[k]) - before.values[k]) > kBeyondNoise;
    return 1000 * differing > looked_at;
}

class VideoCamera : public Camera {
  public:
    explicit VideoCamera(const VideoCameraOptions& options) : options_(options) { open(); }
    ~VideoCamera() override { close(); }
    VideoCamera(const VideoCamera&) = delete;
    VideoCamera& operator=(const VideoCamera&) = delete;

    std::string name() const override {
        return is_device(options_.source) ? "video camera /dev/video" + options_.source
                                          : "video " + options_.source;
    }
    CameraState state() override;
    void set(const std::string& setting, const std::string& value) override;
    Photograph photograph(double exposure_s) override;
    void use_transfer(const std::string& transfer) override {
        linear_ = linear_from_eight_bits(transfer);
    }
    Image8 live_view() override;

  private:
    void open();
    void close();
    void grab();
    void set_exposure(double exposure_s);
    void expect_open() {
        if (!video_) open();
    }
    /// Waits for that frame or a later one, in `newest_`, which is locked meanwhile.
    void next_frame(std::unique_lock<std::mutex>& lock, std::uint64_t number);
    [[noreturn]] void fail_gone(const std::string& why);

    VideoCameraOptions options_;
    std::vector<float> linear_ =
        linear_from_eight_bits("srgb");  ///< of each 8-bit value, on the scale of the file
    std::unique_ptr<Video> video_;
    double exposure_s_ = 0.0;
    bool sets_exposure_ = false, manual_ = false;

    // A device or a stream is read all the time, so that what it shows is now.
    std::thread grabber_;
    std::mutex mutex_;
    std::condition_variable changed_;
    bool stop_ = false;
    std::string ended_;             ///< why no frame comes any more
    std::uint64_t number_ = 0;      ///< of the newest frame
    Image8 newest_;                 ///< RGB
    bool waited_ = false;           ///< its read had to wait for it
    Clock::time_point began_at_{};  ///< that read
};

void VideoCamera::open() {
    video_ = std::make_unique<Video>(options_.source, options_.timeout_ms);
    exposure_s_ = options_.nominal_exposure_s;
    ended_.clear();
    stop_ = false;
    if (is_file(options_.source)) return;
    if (is_device(options_.source)) {
        video_->set(VideoSetting::buffered_frames, 1.0);
        manual_ = video_->set(VideoSetting::automatic_exposure, kManual);
        const double found = video_->get(VideoSetting::exposure);
        sets_exposure_ = found > 0.0 && video_->set(VideoSetting::exposure, found);
        if (found > 0.0) exposure_s_ = found * kExposureUnit_s;
    }
    grabber_ = std::thread([this] { grab(); });
}

void VideoCamera::close() {
    {
        const std::lock_guard lock(mutex_);
        stop_ = true;
    }
    if (grabber_.joinable()) grabber_.join();
    video_.reset();
}

void VideoCamera::grab() {
    // Of the last second's reads, how long they took: a frame that lay in a buffer already comes at
    // once. A reader that fell behind, on a busy machine or while the stream was opened, finds
    // several, and so does one whose network stood still.
    std::deque<std::pair<Clock::time_point, double>> took_s;
    const double frames_per_second = video_->get(VideoSetting::frames_per_second);
    took_s.emplace_back(
        Clock::now(), 1.0 / (frames_per_second > 1.0 ? std::min(frames_per_second, 240.0) : 30.0));
    for (;;) {
        const auto began = Clock::now();
        const std::optional<VideoFrame> frame = video_->read();
        const auto ended = Clock::now();
        const double read_s = std::chrono::duration<double>(ended - began).count();
        took_s.emplace_back(ended, read_s);
        while (ended - took_s.front().first > std::chrono::seconds(1)) took_s.pop_front();
        const double longest_s =
            std::max_element(took_s.begin(), took_s.end(), [](const auto& one, const auto& other) {
                return one.second < other.second;
            })->second;
        const std::lock_guard lock(mutex_);
        waited_ = read_s > 0.25 * longest_s;
        began_at_ = began;
        if (!frame) ended_ = video_->problem();
        if (stop_ || !frame) {
            changed_.notify_all();
            return;
        }
        if (newest_.width != frame->width || newest_.height != frame->height)
            newest_ = Image8(frame->width, frame->height, 3);
        for (std::size_t k = 0; k < newest_.values.size(); k += 3) {
            newest_.values[k] = frame->bgr[k + 2];
            newest_.values[k + 1] = frame->bgr[k + 1];
            newest_.values[k + 2] = frame->bgr[k];
        }
        ++number_;
        changed_.notify_all();
    }
}

void VideoCamera::fail_gone(const std::string& why) {
    close();
    throw CameraFault(CameraTrouble::gone,
                      name() + " sends no more pictures: " + why,
                      "check its cable, power and network; it is looked for again");
}

void VideoCamera::next_frame(std::unique_lock<std::mutex>& lock, std::uint64_t number) {
    const auto deadline = Clock::now() + std::chrono::milliseconds(options_.timeout_ms);
    const bool came =
        changed_.wait_until(lock, deadline, [&] { return number_ >= number || !ended_.empty(); });
    if (came && ended_.empty()) return;
    const std::string why =
        ended_.empty() ? fmt::format("none for {} ms", options_.timeout_ms) : ended_;
    lock.unlock();
    fail_gone(why);
}

void VideoCamera::set_exposure(double exposure_s) {
    if (!(exposure_s > 0.0) || !sets_exposure_) return;
    if (std::abs(exposure_s / exposure_s_ - 1.0) < 1e-3) return;
    video_->set(VideoSetting::exposure, std::max(1.0, std::round(exposure_s / kExposureUnit_s)));
    const double found = video_->get(VideoSetting::exposure);
    if (found > 0.0) exposure_s_ = found * kExposureUnit_s;
    std::unique_lock lock(mutex_);
    next_frame(lock, number_ + static_cast<std::uint64_t>(options_.settling_frames));
}

Photograph VideoCamera::photograph(double exposure_s) {
    expect_open();
    set_exposure(exposure_s);
    Photograph photograph;
    photograph.exposure_s = exposure_s_;
    photograph.black_level = static_cast<double>(linear_.front());
    photograph.saturates_at = static_cast<double>(linear_.back());
    Image8 before;
    int added = 0, seen = 0;
    const auto add = [&](const Image8& frame) {
        ImageF& sum = photograph.image;
        if (sum.empty()) sum = ImageF(frame.width, frame.height, 3);
        if (sum.width != frame.width || sum.height != frame.height)
            throw CameraFault(CameraTrouble::unusable,
                              fmt::format("{} changed its picture from {}x{} to {}x{}",
                                          name(),
                                          sum.width,
                                          sum.height,
                                          frame.width,
                                          frame.height),
                              "leave the camera's resolution alone while it photographs");
        // Those before were still on their way when the picture changed.
        if (++seen <= kMostRestarts * options_.frames && shows_another(before, frame)) {
            std::fill(sum.values.begin(), sum.values.end(), 0.0f);
            added = 0;
        }
        for (std::size_t k = 0; k < frame.values.size(); ++k)
            sum.values[k] += linear_[frame.values[k]];
        ++added;
        before = frame;
    };
    if (grabber_.joinable()) {
        std::unique_lock lock(mutex_);
        // The one on its way began before, and so may those that lie in a buffer: only frames that
        // had to be waited for from now on count.
        const auto asked_at = Clock::now();
        while (added < options_.frames) {
            next_frame(lock, number_ + 1);
            if (waited_ && began_at_ >= asked_at) add(newest_);
        }
    } else {
        for (int k = 0; k < options_.frames; ++k) {
            const auto frame = video_->read();
            if (!frame) fail_gone(video_->problem());
            Image8 rgb(frame->width, frame->height, 3);
            for (std::size_t i = 0; i < rgb.values.size(); ++i)
                rgb.values[i] = frame->bgr[i - i % 3 + 2 - i % 3];
            before = {};  // Whoever made the file has cut it into photographs.
            add(rgb);
        }
    }
    for (float& value : photograph.image.values) value /= static_cast<float>(options_.frames);
    return photograph;
}

Image8 VideoCamera::live_view() {
    expect_open();
    if (!grabber_.joinable()) return {};  // The frames of a file are photographs.
    std::unique_lock lock(mutex_);
    next_frame(lock, 1);
    return newest_;
}

CameraState VideoCamera::state() {
    expect_open();
    CameraState state;
    state.model = name();
    state.settings.push_back(
        {"exposure", fmt::format("{:.4g} s", exposure_s_), {}, sets_exposure_});
    if (is_device(options_.source))
        state.settings.push_back(
            {"gain", fmt::format("{:g}", video_->get(VideoSetting::gain)), {}, true});
    state.settings.push_back({"frames", std::to_string(options_.frames), {}, true});
    if (is_device(options_.source) && !manual_)
        state.warnings.push_back("automatic exposure cannot be switched off from here");
    if (!is_file(options_.source) && !sets_exposure_)
        state.warnings.push_back(
            "its exposure cannot be set from here: set it by hand in the camera, and switch "
            "automatic exposure, gain and white balance off");
    return state;
}

void VideoCamera::set(const std::string& setting, const std::string& value) {
    expect_open();
    double number = 0.0;
    try {
        number = std::stod(value);
    } catch (const std::exception&) {
        throw CameraFault(CameraTrouble::refused,
                          fmt::format("{}: {} \"{}\" is no number", name(), setting, value),
                          "give a number");
    }
    if (setting == "frames" && number >= 1.0 && number <= 1000.0) {
        options_.frames = static_cast<int>(number);
    } else if (setting == "exposure" && sets_exposure_ && number > 0.0) {
        set_exposure(number);
    } else if (setting != "gain" || !video_->set(VideoSetting::gain, number)) {
        throw CameraFault(CameraTrouble::refused,
                          fmt::format("{} does not take {} {}", name(), setting, value),
                          "set it in the camera's own menu or page");
    }
}

}  // namespace

std::unique_ptr<Camera> open_video_camera(const VideoCameraOptions& options) {
    check_argument(options.frames >= 1 && options.settling_frames >= 0 && options.timeout_ms > 0,
                   "a video camera's frames and deadlines are positive");
    return std::make_unique<VideoCamera>(options);
}

}  // namespace livery
