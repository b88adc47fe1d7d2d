#include "capture/patient_camera.h"

#include <chrono>
#include <thread>
#include <utility>

namespace livery {

namespace {

constexpr auto kBetweenTries = std::chrono::milliseconds(500);
constexpr auto kBetweenLooks = std::chrono::milliseconds(20);

bool may_come_back(CameraTrouble trouble) {
    switch (trouble) {
        case CameraTrouble::gone:
        case CameraTrouble::silent:
        case CameraTrouble::held:
        case CameraTrouble::card_full:
            return true;
        case CameraTrouble::refused:
        case CameraTrouble::unusable:
            return false;
    }
    return false;
}

}  // namespace

TakePhotograph patient(Camera& camera, const Progress& progress, TellWait on_wait) {
    return [&camera, progress, on_wait = std::move(on_wait)](double exposure_s) {
        for (bool waited = false;; waited = true) {
            try {
                Photograph photograph = camera.photograph(exposure_s);
                if (waited) on_wait({});
                return photograph;
            } catch (const CameraFault& fault) {
                if (!may_come_back(fault.trouble())) throw;
                on_wait({fault.why(), fault.fix()});
            }
            for (auto left = kBetweenTries; left.count() > 0; left -= kBetweenLooks) {
                progress.check_stop();
                std::this_thread::sleep_for(kBetweenLooks);
            }
        }
    };
}

}  // namespace livery
