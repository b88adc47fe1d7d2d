#include "capture/tethered_camera.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <thread>
#include <utility>

#include <fmt/format.h>
#include <unistd.h>

#include "capture/captures_folder.h"
#include "capture/gphoto_link.h"
#include "capture/gphoto_settings.h"
#include "capture/transfer.h"
#include "core/image_io.h"
#include "core/paths.h"

namespace livery {

namespace {

using std::chrono::milliseconds;
using Clock = std::chrono::steady_clock;

/// Of a camera that says nothing of its exposure; only ratios count.
constexpr double kUnknownExposure_s = 1.0;
/// Of full scale: of the two greens of a square one alone may be at its end.
constexpr double kSureOfSquare = 0.95;

/// A photograph as it came off the card.
struct Taken {
    CameraFile file;
    double exposure_s = 0.0;
    std::string problem;  ///< why its exposure cannot be set
};

/// Whether the error is the connection's or the camera's own, whatever was asked for.
bool is_of_the_connection(int code) {
    return code == GP_ERROR_TIMEOUT || code == GP_ERROR_CAMERA_BUSY ||
           (code <= GP_ERROR_IO && code >= GP_ERROR_IO_LOCK);
}

/// The error as it is, or that of the connection where the camera answers nothing any more: what it
/// refuses then is no setting.
GphotoError as_it_is(GphotoCamera& gphoto, const GphotoError& error) {
    if (is_of_the_connection(error.code)) return error;
    ::CameraStorageInformation* stores = nullptr;
    int count = 0;
    const int answer =
        gp_camera_get_storageinfo(gphoto.camera(), &stores, &count, gphoto.context());
    std::free(stores);
    gphoto.forget();
    if (answer >= 0 || answer == GP_ERROR_NOT_SUPPORTED) return error;
    return {is_of_the_connection(answer) ? answer : GP_ERROR_IO, error.what};
}

/// Sets the nearest exposure that there is.
void expose(GphotoCamera& gphoto, CameraWidget* widget, double exposure_s, Taken& taken) {
    CameraSetting exposure = setting_of("exposure", widget);
    const Widget program = find_widget(gphoto, kProgram);
    const std::string dial = program ? value_of(program.get()) : "";
    if (exposure_s > 0.0 && !is_manual(dial)) {
        taken.problem = "automatic exposure: its dial stands on " + dial;
        return;
    }
    const std::string wanted = exposure_s > 0.0 ? nearest_time(exposure, exposure_s) : "";
    if (exposure_s > 0.0 && wanted.empty()) {
        taken.problem = "automatic exposure: it offers no times, only " + exposure.value;
        return;
    }
    try {
        if (!wanted.empty() && wanted != exposure.value)
            exposure = set_widget(gphoto, "exposure", kExposure, wanted);
    } catch (const GphotoError& error) {
        const GphotoError cause = as_it_is(gphoto, error);
        if (is_of_the_connection(cause.code)) throw cause;
        taken.problem = "automatic exposure: it does not let its time be set (" + error.what + ")";
        return;
    }
    taken.exposure_s = open_time_s(exposure, exposure.value);
    if (!(taken.exposure_s > 0.0))
        taken.problem = "its exposure is " + exposure.value + ", which is no time";
}

/// Some cameras never say that their card is full: they take no photograph.
void check_card(GphotoCamera& gphoto) {
    if (shots_left(gphoto) == 0) throw GphotoError{GP_ERROR_NO_SPACE, "no room for a photograph"};
}

/// Triggers, and gathers what comes onto the card: RAW and JPEG where the camera takes both.
/// gp_camera_capture() would wait for ever, and take a second file for the next photograph.
std::vector<CameraFilePath> trigger(GphotoCamera& gphoto, milliseconds deadline) {
    constexpr milliseconds kPatience{250}, kSecondFile{1500};
    gphoto.check(gp_camera_trigger_capture(gphoto.camera(), gphoto.context()));
    std::vector<CameraFilePath> files;
    auto until = Clock::now() + deadline;
    while (Clock::now() < until) {
        CameraEventType event{};
        void* data = nullptr;
        gphoto.check(gp_camera_wait_for_event(
            gphoto.camera(), static_cast<int>(kPatience.count()), &event, &data, gphoto.context()));
        const std::unique_ptr<void, void (*)(void*)> freed(data, std::free);
        if (event == GP_EVENT_FILE_ADDED && data) {
            files.push_back(*static_cast<CameraFilePath*>(data));
            until = Clock::now() + kSecondFile;
        }
        if (event == GP_EVENT_CAPTURE_COMPLETE && !files.empty()) break;
        if (event == GP_EVENT_TIMEOUT) std::this_thread::sleep_for(milliseconds(2));
    }
    if (files.empty())
        throw GphotoError{GP_ERROR_TIMEOUT, "it was triggered and no photograph came"};
    return files;
}

CameraFile fetch(GphotoCamera& gphoto, const CameraFilePath& path) {
    ::CameraFile* file = nullptr;
    gphoto.check(gp_file_new(&file));
    const std::unique_ptr<::CameraFile, int (*)(::CameraFile*)> freed(file, gp_file_unref);
    gphoto.check(gp_camera_file_get(
        gphoto.camera(), path.folder, path.name, GP_FILE_TYPE_NORMAL, file, gphoto.context()));
    const char* data = nullptr;
    unsigned long size = 0;
    gphoto.check(gp_file_get_data_and_size(file, &data, &size));
    return {path.name, {data, data + size}};
}

Taken take(GphotoCamera& gphoto, double exposure_s, bool has_exposure, milliseconds deadline) {
    Taken taken;
    const Widget widget = find_widget(gphoto, kExposure);
    if (widget) expose(gphoto, widget.get(), exposure_s, taken);
    if (!taken.problem.empty()) return taken;
    check_card(gphoto);
    const std::vector<CameraFilePath> files = trigger(gphoto, deadline);
    if (!widget && has_exposure)
        throw GphotoError{GP_ERROR_CAMERA_BUSY, "its settings could not be read"};
    auto chosen = std::find_if(files.begin(), files.end(), [](const CameraFilePath& path) {
        return is_raw_suffix(path.name);
    });
    if (chosen == files.end()) chosen = files.begin();
    taken.file = fetch(gphoto, *chosen);
    // What cannot be deleted stays on the card, which is told when it is full.
    for (const CameraFilePath& path : files)
        if (gp_camera_file_delete(gphoto.camera(), path.folder, path.name, gphoto.context()) < 0)
            gphoto.forget();
    return taken;
}

/// Programs that have the camera at a USB port open: "name (number)".
std::string programs_with(const std::string& port) {
    if (!port.starts_with("usb:")) return "";
    std::string device = "/dev/bus/usb/" + port.substr(4);
    std::replace(device.begin(), device.end(), ',', '/');
    std::string programs;
    std::error_code error;
    for (std::filesystem::directory_iterator process("/proc", error), end; !error && process != end;
         process.increment(error)) {
        const std::string number = process->path().filename().string();
        if (number.find_first_not_of("0123456789") != std::string::npos ||
            number == std::to_string(::getpid()))
            continue;
        std::error_code hidden;
        for (std::filesystem::directory_iterator open(process->path() / "fd", hidden), last;
             !hidden && open != last;
             open.increment(hidden)) {
            std::error_code gone;
            if (std::filesystem::read_symlink(open->path(), gone) != device || gone) continue;
            std::string name;
            std::getline(std::ifstream(process->path() / "comm"), name);
            programs += (programs.empty() ? "" : ", ") + name + " (" + number + ")";
            break;
        }
    }
    return programs;
}

/// What a number of libgphoto2 means for somebody who photographs.
CameraFault fault_of(const std::string& camera, const std::string& port, const GphotoError& error) {
    const auto fault = [&](CameraTrouble trouble, const std::string& why, const char* fix) {
        const bool says_more = error.what != gp_result_as_string(GP_ERROR);
        return CameraFault(
            trouble,
            fmt::format("{}: {}{}", camera, why, says_more ? " (" + error.what + ")" : ""),
            fix);
    };
    std::string said = error.what;
    std::transform(said.begin(), said.end(), said.begin(), [](unsigned char c) {
        return static_cast<char>(std::tolower(c));
    });
    if (error.code == GP_ERROR_NO_SPACE || said.find("store full") != std::string::npos ||
        said.find("storage full") != std::string::npos)
        return fault(CameraTrouble::card_full,
                     "its card is full",
                     "empty the card or put another in; photographs are deleted from it once they "
                     "are here");
    if (error.code == GP_ERROR_IO_USB_CLAIM || error.code == GP_ERROR_IO_LOCK)
        return fault(CameraTrouble::held,
                     "another program has it: " + programs_with(port),
                     "close that program; on a desktop it is often the file manager: eject the "
                     "camera there, or end gvfs-gphoto2-volume-monitor");
    if (error.code == GP_ERROR_CAMERA_BUSY || said.find("busy") != std::string::npos)
        return fault(CameraTrouble::silent,
                     "it is busy",
                     "wait until it has written its photographs, and leave its menus");
    if (error.code == GP_ERROR_TIMEOUT)
        return fault(CameraTrouble::silent,
                     "it does not answer",
                     "wake it, switch its automatic power-off off, and charge its battery");
    if (is_of_the_connection(error.code))
        return fault(CameraTrouble::gone,
                     "it is not there any more",
                     "check its cable, its power and its network; it is looked for again");
    return fault(CameraTrouble::refused,
                 "it refuses",
                 "check its lens cap, focus (manual) and card, and that it is set to be controlled "
                 "by a computer (PTP)");
}

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
    /// Runs on the camera's thread; `job` may outlive this call, so that it holds what it needs.
    template <typename Job>
    auto ask(milliseconds deadline, Job job) {
        using Answer = decltype(job(std::declval<GphotoCamera&>()));
        const auto answer = std::make_shared<std::optional<Answer>>();
        if (!link_) link_ = std::make_unique<GphotoLink>(options_.port);
        try {
            if (link_->run(deadline, [answer, job](GphotoCamera& gphoto) {
                    try {
                        *answer = job(gphoto);
                    } catch (const GphotoError& error) {
                        throw as_it_is(gphoto, error);
                    }
                }))
                return std::move(**answer);
        } catch (const GphotoError& error) {
            const CameraFault fault = fault_of(name_, options_.port, error);
            if (fault.trouble() == CameraTrouble::gone || fault.trouble() == CameraTrouble::held ||
                fault.trouble() == CameraTrouble::silent)
                link_.reset();  // It is opened anew.
            throw fault;
        }
        link_.reset();
        throw CameraFault(
            CameraTrouble::silent,
            fmt::format("{} has not answered for {:.1f} s",
                        name_,
                        std::chrono::duration<double>(deadline).count()),
            "wake it, switch its automatic power-off off, take its lens cap off and focus by hand; "
            "if it hangs, switch it off and on");
    }
    Photograph decoded(const Taken& taken) const;

    TetheredOptions options_;
    std::string name_;
    std::vector<float> linear_ = linear_from_eight_bits("srgb");  ///< of a JPEG's values
    double exposure_s_ = 0.0;
    bool has_live_view_ = true, has_exposure_ = false;
    std::unique_ptr<GphotoLink> link_;
};

CameraState TetheredCamera::state() {
    CameraState state = ask(options_.answer, [](GphotoCamera& gphoto) {
        CameraState found;
        const Widget model = find_widget(gphoto, kModel);
        found.model = model ? value_of(model.get()) : gphoto.model();
        for (const NamedWidget& named : kSettings)
            if (const Widget widget = find_widget(gphoto, *named.widgets))
                found.settings.push_back(setting_of(named.setting, widget.get()));
        if (const Widget battery = find_widget(gphoto, kBattery)) {
            const double percent = std::atof(value_of(battery.get()).c_str());
            if (percent > 0.0) found.battery = percent / 100.0;
        }
        found.shots_left = shots_left(gphoto);
        return found;
    });
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
    const auto named = std::find_if(kSettings.begin(), kSettings.end(), [&](const auto& one) {
        return setting == one.setting;
    });
    if (named == kSettings.end())
        throw CameraFault(CameraTrouble::refused,
                          fmt::format("{} has no setting {}", name_, setting),
                          "exposure, iso, aperture, format, program and focus can be set");
    const CameraSetting now = ask(options_.answer, [=, named = *named](GphotoCamera& gphoto) {
        return set_widget(gphoto, named.setting, *named.widgets, value);
    });
    if (now.value != value)
        throw CameraFault(
            CameraTrouble::refused,
            fmt::format("{}: {} was to be {} and is {}", name_, setting, value, now.value),
            "set it on the camera itself");
}

/// RAW from a file, as its reader wants it.
Photograph TetheredCamera::decoded(const Taken& taken) const {
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
    Taken taken = ask(deadline + options_.answer,
                      [exposure_s, has_exposure = has_exposure_, deadline](GphotoCamera& gphoto) {
                          return take(gphoto, exposure_s, has_exposure, deadline);
                      });
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
    const std::string jpeg = ask(options_.answer, [](GphotoCamera& gphoto) {
        ::CameraFile* file = nullptr;
        gphoto.check(gp_file_new(&file));
        const std::unique_ptr<::CameraFile, int (*)(::CameraFile*)> freed(file, gp_file_unref);
        std::string bytes;
        if (gp_camera_capture_preview(gphoto.camera(), file, gphoto.context()) < 0) return bytes;
        const char* data = nullptr;
        unsigned long size = 0;
        gphoto.check(gp_file_get_data_and_size(file, &data, &size));
        bytes.assign(data, size);
        return bytes;
    });
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

double seconds_of_shutter_speed(const std::string& text) {
    char* end = nullptr;
    const double first = std::strtod(text.c_str(), &end);
    if (end == text.c_str()) return -1.0;
    if (*end == '/') {
        const char* const below = end + 1;
        const double second = std::strtod(below, &end);
        return end != below && second > 0.0 && first > 0.0 ? first / second : -1.0;
    }
    const bool is_time = *end == '\0' || *end == 's' || *end == '"' || *end == ' ';
    return is_time && first > 0.0 ? first : -1.0;
}

std::vector<FoundCamera> list_tethered_cameras() {
    std::vector<FoundCamera> cameras;
    for (const auto& [model, port] : gphoto_cameras_on_usb())
        cameras.push_back({model, port, programs_with(port)});
    return cameras;
}

std::unique_ptr<Camera> open_tethered_camera(const TetheredOptions& options) {
    return std::make_unique<TetheredCamera>(options);
}

}  // namespace livery
