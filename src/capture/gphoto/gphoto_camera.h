// A camera as libgphoto2 has it, and its settings as libgphoto2 offers them.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <gphoto2/gphoto2.h>

#include "capture/camera.h"

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

/// Widgets by what they do; cameras call them otherwise.
using Names = std::array<const char*, 3>;
inline constexpr Names kExposure{"shutterspeed", "shutterspeed2", "exptime"};
inline constexpr Names kIso{"iso", "isospeed", "500f"};
inline constexpr Names kAperture{"aperture", "f-number", "fnumber"};
inline constexpr Names kFormat{"imageformat", "imagequality", "imagequality2"};
inline constexpr Names kProgram{"expprogram", "autoexposuremode", "exposuremode"};
inline constexpr Names kFocus{"focusmode", "focusmode2", "afmode"};
inline constexpr Names kModel{"cameramodel", "model", "cameraname"};
inline constexpr Names kBattery{"batterylevel", "battery", "5001"};

struct NamedWidget {
    const char* setting;
    const Names* widgets;
};
inline constexpr std::array<NamedWidget, 6> kSettings{{{"exposure", &kExposure},
                                                       {"iso", &kIso},
                                                       {"aperture", &kAperture},
                                                       {"format", &kFormat},
                                                       {"program", &kProgram},
                                                       {"focus", &kFocus}}};

struct FreeWidget {
    void operator()(CameraWidget* widget) const { gp_widget_free(widget); }
};
using Widget = std::unique_ptr<CameraWidget, FreeWidget>;

/// The first of these that the camera has, and its name; null: none.
Widget find_widget(GphotoCamera& gphoto, const Names& names, std::string* found = nullptr);
std::string value_of(CameraWidget* widget);
CameraSetting setting_of(const char* name, CameraWidget* widget);
/// Sets it and reads it back. Throws GphotoError.
CameraSetting set_widget(GphotoCamera& gphoto,
                         const char* name,
                         const Names& names,
                         const std::string& value);
/// On all cards; none: it does not say.
std::optional<int> shots_left(GphotoCamera& gphoto);

}  // namespace livery
