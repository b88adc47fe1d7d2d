// livery-camera, which has hold of a camera: started when it is first asked, and again when it has
// ended.
#pragma once

#include <chrono>
#include <string>

#include <sys/types.h>

#include "capture/camera_messages.h"

namespace livery {

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

}  // namespace livery
