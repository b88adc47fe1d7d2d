// Where projector, camera and mock-up stand, from photographs: no board, the mock-up's own mesh.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "calibration/colour/colour.h"
#include "calibration/registration/pair_pose.h"
#include "calibration/registration/register_scan.h"
#include "core/progress.h"
#include "scene/data_sheet.h"
#include "scene/product.h"

namespace livery {

struct RoomPose {
    View projector, camera;  ///< world: the product's frame
    ProjectorToCamera map;
    PairPose pair;
    Registration registration;
    double capture_seconds = 0.0, solve_seconds = 0.0;
};

/// Shows the Gray code, photographs it, and finds the pair's pose, the mock-up's in it, and what
/// the data sheets' lenses are off by. Throws as calibrate_live(), pose_of_pair() and
/// register_scan().
RoomPose find_room(const BenchPorts& ports,
                   int projector_width,
                   int projector_height,
                   const DataSheets& sheets,
                   const Product& product,
                   const Progress& progress = {});

}  // namespace livery
