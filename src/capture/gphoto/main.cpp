// livery-camera: libgphoto2 in a process of its own, for what a camera says can end it. Answers
// requests on its input (capture/camera_messages.h) until that ends.
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <memory>
#include <string>
#include <thread>

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include "capture/camera_messages.h"
#include "capture/gphoto/gphoto_camera.h"
#include "capture/gphoto/gphoto_photograph.h"

namespace livery {
namespace {

CameraState state_of(GphotoCamera& gphoto) {
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
}

CameraSetting set(GphotoCamera& gphoto, const std::string& setting, const std::string& value) {
    for (const NamedWidget& named : kSettings)
        if (setting == named.setting)
            return set_widget(gphoto, named.setting, *named.widgets, value);
    throw GphotoError{GP_ERROR_NOT_SUPPORTED, "it has no setting " + setting};
}

/// A JPEG; empty where it has no live view.
std::string live_view(GphotoCamera& gphoto) {
    ::CameraFile* file = nullptr;
    gphoto.check(gp_file_new(&file));
    const std::unique_ptr<::CameraFile, int (*)(::CameraFile*)> freed(file, gp_file_unref);
    if (gp_camera_capture_preview(gphoto.camera(), file, gphoto.context()) < 0) return {};
    const char* data = nullptr;
    unsigned long size = 0;
    gphoto.check(gp_file_get_data_and_size(file, &data, &size));
    return {data, size};
}

CameraAnswer answer_to(const CameraRequest& request, GphotoCamera& gphoto) {
    CameraAnswer answer;
    switch (request.kind) {
        case CameraRequest::Kind::list:
            break;
        case CameraRequest::Kind::state:
            answer.state = state_of(gphoto);
            break;
        case CameraRequest::Kind::set:
            answer.setting = set(gphoto, request.setting, request.value);
            break;
        case CameraRequest::Kind::photograph:
            answer.taken =
                take_photograph(gphoto, request.exposure_s, request.has_exposure, request.deadline);
            break;
        case CameraRequest::Kind::live_view:
            answer.live_view = live_view(gphoto);
            break;
    }
    return answer;
}

CameraAnswer answered(const CameraRequest& request, std::unique_ptr<GphotoCamera>& camera) {
    CameraAnswer answer;
    try {
        if (request.kind == CameraRequest::Kind::list) {
            for (const auto& [model, port] : gphoto_cameras_on_usb())
                answer.cameras.push_back({model, port, programs_with(port)});
            return answer;
        }
        if (!camera) camera = std::make_unique<GphotoCamera>(request.port);
        try {
            return answer_to(request, *camera);
        } catch (const GphotoError& error) {
            throw as_it_is(*camera, error);
        }
    } catch (const GphotoError& error) {
        answer.fault = fault_of_gphoto(request.camera, request.port, error);
    }
    return answer;
}

/// Whoever asks is gone: nobody waits for a camera that hangs any more.
void end_with(int requests) {
    std::thread([requests] {
        for (pollfd gone{requests, 0, 0}; ::poll(&gone, 1, -1) < 1;) continue;
        constexpr auto kGoodbye = std::chrono::seconds(1);
        std::this_thread::sleep_for(kGoodbye);
        std::_Exit(0);
    }).detach();
}

int serve() {
    // libgphoto2 writes to a camera that has hung up, and closes file 0 where a connection fails
    // half way.
    std::signal(SIGPIPE, SIG_IGN);
    const int requests = ::fcntl(STDIN_FILENO, F_DUPFD_CLOEXEC, 3);
    const int answers = ::fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, 3);
    const int null = ::open("/dev/null", O_RDWR | O_CLOEXEC);
    if (requests < 0 || answers < 0 || null < 0) return 2;
    ::dup2(null, STDIN_FILENO);
    ::dup2(null, STDOUT_FILENO);
    end_with(requests);
    std::unique_ptr<GphotoCamera> camera;
    while (const auto message = receive_message(requests, {})) {
        if (!send_message(answers, message_of(answered(request_in(*message), camera)))) break;
    }
    return 0;
}

}  // namespace
}  // namespace livery

int main() {
    try {
        return livery::serve();
    } catch (const std::exception& error) {
        std::fprintf(stderr, "livery-camera: %s\n", error.what());
        return 2;
    }
}
