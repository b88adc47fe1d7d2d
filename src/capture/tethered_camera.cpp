#include "capture/tethered_camera.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/types.h>
#include <sys/wait.h>
#include <unistd.h>

#include "capture/camera.h"
#include "capture/camera_messages.h"
#include "capture/captures_folder.h"
#include "capture/transfer.h"
#include "core/error.h"
#include "core/image_io.h"
#include "core/log.h"
#include "core/paths.h"
#include "core/system/programs.h"

namespace livery {

namespace {

/// One thread at a time.
class CameraProcess {
  public:
    CameraProcess() = default;
    ~CameraProcess() { end(); }
    CameraProcess(const CameraProcess&) = delete;
    CameraProcess& operator=(const CameraProcess&) = delete;

    /// What it answers within the deadline, faults thrown. Throws CameraFault `silent`, with the
    /// process ended, where it does not, and `gone` where the camera's library breaks off.
    CameraAnswer ask(const CameraRequest& request, std::chrono::milliseconds deadline);
    /// Lets the camera go: for a second, then the process is killed.
    void end();

  private:
    void start();
    /// Ends it, with what is known of why.
    CameraFault broken_off(const std::string& camera, const std::string& said);
    /// How it has ended, in words.
    std::string ended();

    pid_t id_ = -1;
    int requests_ = -1, answers_ = -1;
};

using Clock = std::chrono::steady_clock;

constexpr auto kGoodbye = std::chrono::milliseconds(1000);

void close_file(int& file) {
    if (file >= 0) ::close(std::exchange(file, -1));
}

/// A pipe's two ends; those that were not handed on are closed.
struct Pipe {
    std::array<int, 2> ends{-1, -1};
    Pipe() {
        if (::pipe2(ends.data(), O_CLOEXEC) == 0) return;
        throw std::runtime_error(std::string("cannot make a pipe: ") + std::strerror(errno));
    }
    ~Pipe() {
        for (int& end : ends) close_file(end);
    }
    Pipe(const Pipe&) = delete;
    Pipe& operator=(const Pipe&) = delete;
};

/// Writing to a process that has ended is an answer, not this program's end.
class NoBrokenPipe {
  public:
    NoBrokenPipe() {
        ::sigemptyset(&broken_);
        ::sigaddset(&broken_, SIGPIPE);
        ::pthread_sigmask(SIG_BLOCK, &broken_, &before_);
    }
    ~NoBrokenPipe() {
        const timespec now{};
        while (::sigtimedwait(&broken_, nullptr, &now) == SIGPIPE) continue;
        ::pthread_sigmask(SIG_SETMASK, &before_, nullptr);
    }
    NoBrokenPipe(const NoBrokenPipe&) = delete;
    NoBrokenPipe& operator=(const NoBrokenPipe&) = delete;

  private:
    sigset_t broken_{}, before_{};
};

void CameraProcess::start() {
    Pipe requests, answers;
    id_ = start_program("livery-camera",
                        {},
                        {{requests.ends[0], STDIN_FILENO}, {answers.ends[1], STDOUT_FILENO}},
                        "the program that talks to cameras");
    requests_ = std::exchange(requests.ends[1], -1);
    answers_ = std::exchange(answers.ends[0], -1);
}

CameraFault CameraProcess::broken_off(const std::string& camera, const std::string& said) {
    const std::string how = said.empty() ? ended() : said;
    end();
    log_line(LogLevel::warning, "livery-camera ended: " + how);
    return {CameraTrouble::gone,
            fmt::format("{}: what it said has ended the camera's library ({})", camera, how),
            "it is started again; if that goes on, switch the camera off and on, and let it name "
            "its files otherwise"};
}

std::string CameraProcess::ended() {
    int status = 0;
    ::kill(id_, SIGKILL);  // It may have closed its answers and hang.
    while (::waitpid(id_, &status, 0) < 0 && errno == EINTR) continue;
    id_ = -1;
    end();
    return WIFSIGNALED(status) ? fmt::format("by {}", ::strsignal(WTERMSIG(status)))
                               : fmt::format("with {}", WEXITSTATUS(status));
}

CameraAnswer CameraProcess::ask(const CameraRequest& request, std::chrono::milliseconds deadline) {
    if (id_ < 0) start();
    const auto until = Clock::now() + deadline;
    std::optional<CameraMessage> answer;
    {
        const NoBrokenPipe not_broken;
        if (send_message(requests_, message_of(request))) answer = receive_message(answers_, until);
    }
    if (!answer && Clock::now() >= until) {
        end();
        throw CameraFault(
            CameraTrouble::silent,
            fmt::format("{} has not answered for {:.1f} s",
                        request.camera,
                        std::chrono::duration<double>(deadline).count()),
            "wake it, switch its automatic power-off off, take its lens cap off and focus by hand; "
            "if it hangs, switch it off and on");
    }
    if (!answer) throw broken_off(request.camera, "");
    CameraAnswer result;
    try {
        result = answer_in(*answer);
    } catch (const FileError& error) {
        // It has overwritten its own memory.
        throw broken_off(request.camera, error.what());
    }
    if (!result.fault) return result;
    const CameraTrouble trouble = result.fault->trouble();
    const bool anew = trouble == CameraTrouble::gone || trouble == CameraTrouble::held ||
                      trouble == CameraTrouble::silent;
    if (anew) end();
    throw CameraFault(*result.fault);
}

void CameraProcess::end() {
    close_file(requests_);
    close_file(answers_);
    if (id_ < 0) return;
    const auto give_up = Clock::now() + kGoodbye;
    while (::waitpid(id_, nullptr, WNOHANG) == 0) {
        if (Clock::now() >= give_up) {
            ::kill(id_, SIGKILL);
            ::waitpid(id_, nullptr, 0);
            break;
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    id_ = -1;
}

using std::chrono::milliseconds;

/// Of a camera that says nothing of its exposure; only ratios count.
constexpr double kUnknownExposure_s = 1.0;
/// Of full scale: of the two greens of a square one alone may be at its end.
constexpr double kSureOfSquare = 0.95;

class TetheredCamera : public Camera {
  public:
    explicit TetheredCamera(const TetheredOptions& options)
        : options_(options),
          name_("camera " + (options.port.empty() ? "on USB" : "at " + options.port)) {
        state();  // Whatever keeps it from working is said now.
    }

    std::string name() const override { return name_; }
    CameraState state() override;
    void set(const std::string& setting, const std::string& value) override;
    Photograph photograph(double exposure_s) override;
    void use_transfer(const std::string& transfer) override {
        linear_ = linear_from_eight_bits(transfer);
    }
    Image8 live_view() override;

  private:
    CameraAnswer ask(CameraRequest request, milliseconds deadline) {
        request.camera = name_;
        request.port = options_.port;
        return process_.ask(request, deadline);
    }
    Photograph decoded(const TakenPhotograph& taken) const;

    TetheredOptions options_;
    std::string name_;
    std::vector<float> linear_ = linear_from_eight_bits("srgb");  ///< of a JPEG's values
    double exposure_s_ = 0.0;
    bool has_live_view_ = true, has_exposure_ = false;
    CameraProcess process_;
};

CameraState TetheredCamera::state() {
    CameraRequest request;
    request.kind = CameraRequest::Kind::state;
    CameraState state = ask(request, options_.answer).state;
    for (const CameraSetting& setting : state.settings) {
        has_exposure_ = has_exposure_ || setting.name == "exposure";
        if (setting.name == "program" && !is_manual(setting.value))
            state.warnings.push_back("automatic exposure: its dial stands on " + setting.value +
                                     "; turn it to M");
        if (setting.name == "format" && !is_raw_format(setting.value) &&
            std::any_of(setting.choices.begin(), setting.choices.end(), is_raw_format))
            state.warnings.push_back(
                "it gives " + setting.value +
                ", whose numbers a picture style bends: set its format to RAW");
        if (setting.name == "focus" && setting.value.find("utomatic") != std::string::npos)
            state.warnings.push_back("automatic focus: switch it to manual");
    }
    if (!has_exposure_)
        state.warnings.push_back(
            "its exposure time cannot be set or read from here: set it by hand, the same for all");
    if (state.battery && *state.battery < 0.2)
        state.warnings.push_back("its battery is nearly empty");
    if (state.shots_left == 0) state.warnings.push_back("its card is full");
    return state;
}

void TetheredCamera::set(const std::string& setting, const std::string& value) {
    CameraRequest request;
    request.kind = CameraRequest::Kind::set;
    request.setting = setting;
    request.value = value;
    const CameraSetting now = ask(request, options_.answer).setting;
    if (now.value != value)
        throw CameraFault(
            CameraTrouble::refused,
            fmt::format("{}: {} was to be {} and is {}", name_, setting, value, now.value),
            "set it on the camera itself");
}

/// RAW from a file, as its reader wants it.
Photograph TetheredCamera::decoded(const TakenPhotograph& taken) const {
    const std::filesystem::path name(taken.file.name);
    Photograph photograph;
    try {
        if (is_raw_suffix(name)) {
            std::string place =
                (std::filesystem::temp_directory_path() / "livery-XXXXXX").string() +
                name.extension().string();
            const int file =
                ::mkstemps(place.data(), static_cast<int>(name.extension().string().size()));
            if (file < 0) throw FileError(place, "", "cannot be made", "room for a photograph");
            ::close(file);
            const std::unique_ptr<const std::string, void (*)(const std::string*)> gone(
                &place, [](const std::string* path) { ::unlink(path->c_str()); });
            write_text_file(
                place,
                {reinterpret_cast<const char*>(taken.file.bytes.data()), taken.file.bytes.size()});
            Capture capture;
            capture.file = place;
            capture.raw_half = true;
            capture.exposure_s = taken.exposure_s;
            photograph = load_photograph(capture);
            photograph.saturates_at *= kSureOfSquare;
            photograph.file = std::make_shared<CameraFile>(taken.file);
        } else {
            ImageFile picture = read_image_bytes(
                {reinterpret_cast<const char*>(taken.file.bytes.data()), taken.file.bytes.size()},
                name);
            if (picture.image.channels != 3 || picture.full_scale != 255.0)
                throw FileError(
                    name, "", fmt::format("{} channels", picture.image.channels), "a colour JPEG");
            for (float& value : picture.image.values)
                value = linear_[static_cast<std::size_t>(value)];
            photograph.image = std::move(picture.image);
            photograph.saturates_at = 255.0;
        }
    } catch (const FileError& error) {
        throw CameraFault(
            CameraTrouble::unusable,
            fmt::format(
                "{}: the photograph {} cannot be read: {}", name_, taken.file.name, error.what()),
            "check the cable; set the camera to RAW, or to JPEG of full colour");
    }
    photograph.name = taken.file.name;
    photograph.exposure_s = taken.exposure_s;
    return photograph;
}

Photograph TetheredCamera::photograph(double exposure_s) {
    const double longest_s = std::max(exposure_s, exposure_s_);
    const auto deadline =
        options_.photograph + milliseconds(static_cast<int>(1000.0 * std::min(longest_s, 3600.0)));
    CameraRequest request;
    request.kind = CameraRequest::Kind::photograph;
    request.exposure_s = exposure_s;
    request.has_exposure = has_exposure_;
    request.deadline = deadline;
    TakenPhotograph taken = ask(request, deadline + options_.answer).taken;
    if (!taken.problem.empty())
        throw CameraFault(CameraTrouble::refused,
                          name_ + ": " + taken.problem,
                          "turn its dial to M, and switch automatic ISO off");
    if (!has_exposure_) taken.exposure_s = kUnknownExposure_s;
    exposure_s_ = taken.exposure_s;
    return decoded(taken);
}

Image8 TetheredCamera::live_view() {
    if (!has_live_view_) return {};
    CameraRequest request;
    request.kind = CameraRequest::Kind::live_view;
    const std::string jpeg = ask(request, options_.answer).live_view;
    has_live_view_ = !jpeg.empty();
    if (jpeg.empty()) return {};
    try {
        const ImageFile picture = read_image_bytes(jpeg, "live view.jpg");
        Image8 seen(picture.image.width, picture.image.height, 3);
        const auto channels = static_cast<std::size_t>(picture.image.channels);
        for (std::size_t i = 0; i < seen.pixel_count(); ++i)
            for (std::size_t c = 0; c < 3; ++c)
                seen.values[3 * i + c] = static_cast<std::uint8_t>(
                    picture.image.values[channels * i + std::min(c, channels - 1)]);
        return seen;
    } catch (const FileError&) {
        return {};  // One frame of many.
    }
}

}  // namespace

std::vector<FoundCamera> list_tethered_cameras() {
    CameraRequest request;
    request.kind = CameraRequest::Kind::list;
    request.camera = "the list of cameras";
    return CameraProcess().ask(request, TetheredOptions().answer).cameras;
}

std::unique_ptr<Camera> open_tethered_camera(const TetheredOptions& options) {
    return std::make_unique<TetheredCamera>(options);
}

}  // namespace livery
