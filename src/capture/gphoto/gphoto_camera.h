// A camera as libgphoto2 has it.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include <gphoto2/gphoto2.h>

namespace livery {

/// What libgphoto2 refused, on its way to a CameraFault.
struct GphotoError {
    int code = 0;
    std::string what;
};

/// Opened; throws GphotoError. One thread.
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

/// Model and port of what is on USB.
std::vector<std::pair<std::string, std::string>> gphoto_cameras_on_usb();

}  // namespace livery
