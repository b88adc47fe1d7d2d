// The settings of a camera, as libgphoto2 offers them.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>

#include "capture/camera.h"
#include "capture/gphoto/gphoto_camera.h"

namespace livery {

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
