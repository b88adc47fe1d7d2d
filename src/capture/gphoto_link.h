// libgphoto2 on a thread that may hang. For tethered_camera.cpp alone.
#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <gphoto2/gphoto2.h>

namespace livery {

/// What libgphoto2 refused, on its way to a CameraFault.
struct GphotoError {
    int code = 0;
    std::string what;
};

/// A camera as libgphoto2 has it. Everything on one thread; throws GphotoError.
class GphotoCamera {
  public:
    explicit GphotoCamera(const std::string& port);
    ~GphotoCamera();
    GphotoCamera(const GphotoCamera&) = delete;
    GphotoCamera& operator=(const GphotoCamera&) = delete;

    void check(int result);
    void forget() { said_.clear(); }  ///< what it said of something that does not matter
    ::Camera* camera() { return camera_; }
    ::GPContext* context() { return context_; }
    const std::string& model() const { return model_; }

  private:
    void open(const std::string& port);

    ::GPContext* context_;
    ::Camera* camera_ = nullptr;
    std::string said_, model_;
    bool is_open_ = false;
};

/// One camera and its thread.
class GphotoLink {
  public:
    explicit GphotoLink(std::string port);
    ~GphotoLink();  ///< waits a second for the camera to be let go, then leaves it to the thread
    GphotoLink(const GphotoLink&) = delete;
    GphotoLink& operator=(const GphotoLink&) = delete;

    /// Runs it with the camera, which is opened first where it is not. False: not in time; the link
    /// is of no use any more. What `job` throws comes out here.
    bool run(std::chrono::milliseconds deadline, std::function<void(GphotoCamera&)> job);

  private:
    struct Shared;
    std::shared_ptr<Shared> shared_;
};

/// Model and port of what is on USB.
std::vector<std::pair<std::string, std::string>> gphoto_cameras_on_usb();

}  // namespace livery
