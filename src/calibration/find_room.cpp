#include <chrono>
#include <optional>
#include <span>

#include <glm/matrix.hpp>

#include "calibration/calibrate_live.h"
#include "calibration/registration/pair_pose.h"
#include "calibration/registration/register_scan.h"
#include "core/error.h"
#include "core/hash.h"
#include "core/time.h"

namespace livery {

namespace {

std::string hash_of(const LiveMap& seen, const DataSheets& sheets, const Mesh& mesh) {
    Hasher hasher;
    const int sizes[] = {
        seen.map.camera_px.width, seen.map.camera_px.height, seen.camera_width, seen.camera_height};
    hasher.add(std::span<const int>(sizes));
    hasher.add(std::span<const float>(seen.map.camera_px.values));
    const double said[] = {sheets.throw_ratio,
                           sheets.lens_shift,
                           sheets.focal_mm,
                           sheets.sensor_width_mm,
                           sheets.lens_distance_mm};
    hasher.add(std::span<const double>(said));
    hasher.add(shape_hash(mesh));
    return hasher.hex();
}

/// What was found from the same before. A file that cannot be read is as if nothing had been.
std::optional<RoomGeometry> found_before(const std::filesystem::path& checkpoint,
                                         const std::string& made_of) {
    std::error_code error;
    if (checkpoint.empty() || !std::filesystem::exists(checkpoint, error)) return std::nullopt;
    try {
        RoomGeometry room = read_room_file(checkpoint);
        if (room.made_of == made_of) return room;
    } catch (const FileError&) {
    }
    return std::nullopt;
}

RoomGeometry solve_room(const LiveMap& seen,
                        View projector,
                        const DataSheets& sheets,
                        const Mesh& mesh,
                        const Progress& progress) {
    const Sight sight{camera_of(sheets, seen.camera_width, seen.camera_height), seen.map};
    const PairPose pair = pose_of_pair(
        sight.camera, projector, sight.map, sheets.lens_distance_mm, 1, progress.part(0.0, 0.1));
    projector.view_from_world = pair.projector_from_camera;
    RegistrationOptions registering;
    registering.prior = data_sheet_prior();
    const Registration found =
        register_scan(mesh, projector, {sight}, registering, progress.part(0.1, 1.0));
    RoomGeometry room;
    room.projector = found.refined.projector;
    room.camera = found.refined.cameras.front();
    room.pair_median_px = pair.median_px;
    room.pair_inlier_share = pair.inlier_share;
    room.median_px = found.refined.median_px;
    room.rms_px = found.refined.rms_px;
    room.rms_mm = found.refined.rms_mm;
    room.inliers = found.refined.inliers;
    room.correspondences = found.refined.correspondences;
    room.agreement = found.evidence.agreement();
    room.free_turns = found.free.count;
    room.turns_through_mm = found.free.through_mm;
    room.warnings = found.warnings;
    return room;
}

/// Turns the room about a sphere's centre until the projector's axes are those of `said`: its
/// photographs do not tell them. Any other product stays as it is.
void take_turn_of(const View& said, RoomGeometry& room) {
    if (room.free_turns != 3) return;
    const glm::dvec3 centre = room.turns_through_mm;
    const glm::dmat3 turn =
        glm::transpose(room.projector.view_from_world.rotation) * said.view_from_world.rotation;
    const Rigid3 found_from_said{turn, centre - turn * centre};
    for (View* view : {&room.projector, &room.camera}) {
        view->view_from_world = view->view_from_world * found_from_said;
    }
}

}  // namespace

bool finds_room(const CalibrationSettings& settings) {
    return !settings.projector && settings.data_sheets && settings.product;
}

RoomPose find_room(const BenchPorts& ports,
                   const CalibrationSettings& settings,
                   const Progress& progress,
                   const std::filesystem::path& checkpoint) {
    check_argument(finds_room(settings), "a room is found from data sheets and a product's mesh");
    const DataSheets& sheets = *settings.data_sheets;
    const Mesh& mesh = settings.product->mesh;
    RoomPose room;
    room.seen = photograph_map(ports, settings, progress.part(0.0, 0.6));

    const auto start = std::chrono::steady_clock::now();
    const std::string made_of = hash_of(room.seen, sheets, mesh);
    if (auto before = found_before(checkpoint, made_of)) {
        room.geometry = std::move(*before);
    } else {
        room.geometry = solve_room(room.seen,
                                   projector_of(sheets, settings.width, settings.height),
                                   sheets,
                                   mesh,
                                   progress.part(0.6, 1.0));
        room.geometry.made_of = made_of;
        if (!checkpoint.empty()) write_room_file(checkpoint, room.geometry);
    }
    if (settings.turned_as) take_turn_of(*settings.turned_as, room.geometry);
    room.solve_seconds = seconds_since(start);
    return room;
}

}  // namespace livery
