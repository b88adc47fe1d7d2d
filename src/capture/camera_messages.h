// What the program and livery-camera say to each other: JSON with bytes beside it, over pipes.
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "capture/camera.h"

namespace livery {

/// A photograph as it came off the card.
struct TakenPhotograph {
    CameraFile file;
    double exposure_s = 0.0;
    std::string problem;  ///< why its exposure cannot be set
};

struct FoundCamera {
    std::string model, port;
    std::string held_by;  ///< programs that have it open, with their numbers; empty: nobody
};

struct CameraRequest {
    enum class Kind { list, state, set, photograph, live_view };
    Kind kind = Kind::state;
    std::string camera, port;    ///< how faults call it; where it is
    std::string setting, value;  ///< to set
    double exposure_s = 0.0;     ///< of the photograph
    bool has_exposure = false;   ///< it has had a setting of that name
    std::chrono::milliseconds deadline{0};
};

/// What the request asked for, or why not.
struct CameraAnswer {
    std::optional<CameraFault> fault;
    std::vector<FoundCamera> cameras;
    CameraState state;
    CameraSetting setting;
    TakenPhotograph taken;
    std::string live_view;  ///< a JPEG
};

struct CameraMessage {
    std::string json, bytes;
};
CameraMessage message_of(const CameraRequest& request);
CameraMessage message_of(const CameraAnswer& answer);
/// Throw FileError for what is no such message.
CameraRequest request_in(const CameraMessage& message);
CameraAnswer answer_in(const CameraMessage& message);

/// False: nobody reads it.
bool send_message(int file, const CameraMessage& message);
/// Nothing at the end, and at the deadline (none: waits for ever). Throws FileError for a message
/// of more than a gigabyte.
std::optional<CameraMessage> receive_message(
    int file, std::optional<std::chrono::steady_clock::time_point> deadline);

}  // namespace livery
