// Where projector, camera and mock-up stand, from photographs: no board, the mock-up's own mesh.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "calibration/colour/colour.h"
#include "core/progress.h"
#include "scene/data_sheet.h"
#include "scene/product.h"
#include "scene/room.h"

namespace livery {

struct RoomPose {
    RoomGeometry geometry;
    ProjectorToCamera map;
    Photograph white, black;  ///< everything lit, and nothing; empty: they were taken before
    /// Photographs that the map was made of, of those that were recorded: role and file of each.
    std::vector<std::pair<std::string, std::string>> kept;
    double capture_seconds = 0.0, solve_seconds = 0.0;
    /// Of capture_seconds, within the camera's and the projector's ports; 0: nobody looked.
    double camera_seconds = 0.0, projector_seconds = 0.0;
};

/// Shows the Gray code (and fringes, by `places`), photographs it, and finds the pair's pose, the
/// mock-up's in it, and what the data sheets' lenses are off by. `checkpoint` (a file; empty: none)
/// keeps what was found: it is not sought again while photographs, data sheets and mesh are the
/// same. Throws as calibrate_live(), pose_of_pair() and register_scan().
RoomPose find_room(const BenchPorts& ports,
                   int projector_width,
                   int projector_height,
                   const DataSheets& sheets,
                   const Product& product,
                   const Progress& progress = {},
                   const std::filesystem::path& checkpoint = {},
                   PlaceCode places = PlaceCode::gray);

/// Turns the room about a sphere's centre until the projector's axes are those of `said`: its
/// photographs do not tell them. Any other product stays as it is.
void take_turn_of(const View& said, RoomGeometry& room);

}  // namespace livery
