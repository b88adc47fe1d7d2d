#include "capture/gphoto/gphoto_photograph.h"

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <thread>
#include <vector>

#include <fmt/format.h>
#include <unistd.h>

#include "capture/camera.h"
#include "capture/captures_folder.h"
#include "capture/gphoto/gphoto_camera.h"
#include "core/image_io.h"

namespace livery {

namespace {

using std::chrono::milliseconds;
using Clock = std::chrono::steady_clock;

/// Sets the nearest exposure that there is.
void expose(GphotoCamera& gphoto, CameraWidget* widget, double exposure_s, TakenPhotograph& taken) {
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

}  // namespace

bool is_of_the_connection(int code) {
    return code == GP_ERROR_TIMEOUT || code == GP_ERROR_CAMERA_BUSY ||
           (code <= GP_ERROR_IO && code >= GP_ERROR_IO_LOCK);
}

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

TakenPhotograph take_photograph(GphotoCamera& gphoto,
                                double exposure_s,
                                bool has_exposure,
                                milliseconds deadline) {
    TakenPhotograph taken;
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

CameraFault fault_of_gphoto(const std::string& camera,
                            const std::string& port,
                            const GphotoError& error) {
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

}  // namespace livery
