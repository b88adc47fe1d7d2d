#include "capture/gphoto/gphoto_photograph.h"

#include <algorithm>
#include <cstdlib>
#include <memory>
#include <thread>
#include <vector>

#include "capture/camera_words.h"
#include "capture/captures_folder.h"
#include "capture/gphoto/gphoto_settings.h"
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

}  // namespace livery
