// What libgphoto2 refuses, for somebody who photographs.
#pragma once

#include <string>

#include "capture/camera.h"
#include "capture/gphoto/gphoto_camera.h"

namespace livery {

/// Programs that have the camera at a USB port open: "name (number)". This one does not count.
std::string programs_with(const std::string& port);
/// What a number of libgphoto2 means.
CameraFault fault_of_gphoto(const std::string& camera,
                            const std::string& port,
                            const GphotoError& error);

}  // namespace livery
