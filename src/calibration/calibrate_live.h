// A calibration through the bench's ports: projects, photographs and solves.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "calibration/settings.h"
#include "core/bench_ports.h"
#include "core/progress.h"
#include "scene/colour_calibration.h"
#include "scene/room.h"

namespace livery {

/// Time that photographing took, and of it that within the camera's and the projector's ports (0:
/// nobody looked).
struct CaptureSeconds {
    double all = 0.0, camera = 0.0, projector = 0.0;
};

/// Where the camera sees each projector pixel, photographed and judged as calibrate_live() does it.
struct LiveMap {
    ProjectorToCamera map;
    Photograph white, black;  ///< everything lit, and nothing; empty: they were taken before
    int camera_width = 0, camera_height = 0;
    std::vector<std::string> warnings;
    /// Photographs that it was made of, of those that were recorded: role and file of each.
    std::vector<std::pair<std::string, std::string>> kept;
    CaptureSeconds captured;
};

/// Where projector, camera and mock-up stand, from photographs: no board, the mock-up's own mesh.
struct RoomPose {
    RoomGeometry geometry;
    LiveMap seen;
    double solve_seconds = 0.0;
};

struct CalibrationResult {
    std::optional<RoomPose> room;   ///< as found; nothing: the settings said it, or nobody does
    std::optional<View> projector;  ///< where it stands; nothing: that is not known
    ColourCalibration calibration;  ///< with what the camera does not see predicted from the pose
    ImageF irradiance;              ///< the settings'
    ProjectorToCamera map;
    /// The colour ones, a steady change of the lamp taken out, for a second look with other
    /// settings.
    std::vector<RoledPhotograph> captures;
    std::vector<Pattern> patterns;
    /// Photographs that it was made of, of those that were recorded: role and file of each.
    std::vector<std::pair<std::string, std::string>> kept;
    /// The last photographs of white and of black, to tell later whether something has changed;
    /// empty: the photographs were taken before.
    Photograph white, black;
    CaptureSeconds captured;  ///< of the colours
    double solve_seconds = 0.0, predict_seconds = 0.0;
    int colour_photographs = 0, latency_photographs = 0;

    /// The room's and the colours' together.
    CaptureSeconds all_captured() const;
    double all_solve_seconds() const;
};

/// Whether the photographs are taken now (their latency and exposure are found first, what fails is
/// repeated, a colorimeter reads what is shown) or are what they are (`BenchPorts::turn_to`), the
/// same pictures are asked for, and the photographs are judged and solved the same way; then what
/// the camera does not see is predicted, and the calibration sealed. No room is sought: the
/// settings' data sheets are not looked at. Throws Refused, FileError, std::invalid_argument.
CalibrationResult calibrate_live(const BenchPorts& bench,
                                 CalibrationSettings settings,
                                 const Progress& progress = {});

/// Gray code, and fringes with `settings.places`, alone: for whoever must know where things stand
/// before colours are photographed. Throws as calibrate_live().
LiveMap photograph_map(const BenchPorts& bench,
                       const CalibrationSettings& settings,
                       const Progress& progress = {});

/// Whether where everything stands is to be found first.
bool finds_room(const CalibrationSettings& settings);

/// Shows the Gray code (and fringes, by `places`), photographs it, and finds the pair's pose, the
/// mock-up's in it, and what the data sheets' lenses are off by; a sphere is turned as the settings
/// say. `checkpoint` (a file; empty: none) keeps what was found: it is not sought again while
/// photographs, data sheets and mesh are the same. Throws as calibrate_live(), pose_of_pair() and
/// register_scan().
RoomPose find_room(const BenchPorts& ports,
                   const CalibrationSettings& settings,
                   const Progress& progress = {},
                   const std::filesystem::path& checkpoint = {});

}  // namespace livery
