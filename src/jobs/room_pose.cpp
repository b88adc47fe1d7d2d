#include "jobs/room_pose.h"

#include <chrono>

namespace livery {

RoomPose find_room(const BenchPorts& ports,
                   int projector_width,
                   int projector_height,
                   const DataSheets& sheets,
                   const Product& product,
                   const Progress& progress) {
    LiveOptions options;
    options.width = projector_width;
    options.height = projector_height;
    LiveMap seen = photograph_map(ports, options, progress);
    RoomPose room;
    room.map = std::move(seen.map);
    room.capture_seconds = seen.capture_seconds;

    const auto start = std::chrono::steady_clock::now();
    View projector = projector_of(sheets, projector_width, projector_height);
    Sight sight{camera_of(sheets, seen.camera_width, seen.camera_height), room.map};
    room.pair =
        pose_of_pair(sight.camera, projector, sight.map, sheets.lens_distance_mm, 1, progress);
    projector.view_from_world = room.pair.projector_from_camera;
    RegistrationOptions registering;
    registering.prior = data_sheet_prior();
    room.registration = register_scan(product.mesh, projector, {sight}, registering, progress);
    room.projector = room.registration.refined.projector;
    room.camera = room.registration.refined.cameras.front();
    room.solve_seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return room;
}

}  // namespace livery
