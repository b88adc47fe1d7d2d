// A photograph by libgphoto2.
#pragma once

#include <chrono>
#include <string>

#include "capture/camera.h"
#include "capture/camera_messages.h"
#include "capture/gphoto/gphoto_camera.h"

namespace livery {

/// Whether the error is the connection's or the camera's own, whatever was asked for.
bool is_of_the_connection(int code);
/// The error as it is, or that of the connection where the camera answers nothing any more: what it
/// refuses then is no setting.
GphotoError as_it_is(GphotoCamera& gphoto, const GphotoError& error);

/// Sets the nearest exposure that there is (0: as it is set), triggers, fetches the photograph, and
/// deletes it from the card. Throws GphotoError.
TakenPhotograph take_photograph(GphotoCamera& gphoto,
                                double exposure_s,
                                bool has_exposure,
                                std::chrono::milliseconds deadline);

/// Programs that have the camera at a USB port open: "name (number)". This one does not count.
std::string programs_with(const std::string& port);
/// What a number of libgphoto2 means.
CameraFault fault_of_gphoto(const std::string& camera,
                            const std::string& port,
                            const GphotoError& error);

}  // namespace livery
