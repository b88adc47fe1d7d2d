#include "jobs/bench_calibration.h"

#include <chrono>
#include <utility>

#include <glm/matrix.hpp>

#include "calibration/predict.h"
#include "jobs/capture_run.h"
#include "jobs/projector_irradiance.h"
#include "scene/mockup_mask.h"

namespace livery {

namespace {

/// Of each colour picture, mosaics included: a second photograph takes a third of their noise away,
/// and makes a calibration of some fifty photographs a tenth longer.
constexpr int kColourShots = 2;

/// Turns the room about a sphere's centre until the projector's axes are those of `said`.
void take_turn_of(const View& said, RoomPose& room) {
    const glm::dvec3 centre = room.registration.free.through_mm;
    const glm::dmat3 turn =
        glm::transpose(room.projector.view_from_world.rotation) * said.view_from_world.rotation;
    const Rigid3 found_from_said{turn, centre - turn * centre};
    for (View* view : {&room.projector, &room.camera}) {
        view->view_from_world = view->view_from_world * found_from_said;
    }
}

}  // namespace

LiveOptions live_options_of(const BenchCalibrationRequest& request) {
    LiveOptions options;
    options.shots = kColourShots;
    options.width = request.width;
    options.height = request.height;
    options.colour.made_with = request.made_with;
    options.places = request.places;
    options.map = request.map;
    if (request.camera_to_xyz) options.colour.camera_to_xyz = *request.camera_to_xyz;
    if (request.projector && request.product)
        options.mockup = mockup_mask(request.product->mesh, *request.projector);
    return options;
}

BenchCalibration calibrate_through_ports(const BenchPorts& ports,
                                         const BenchCalibrationRequest& request,
                                         const Progress& progress) {
    const LiveOptions options = live_options_of(request);
    BenchCalibration result;
    result.live = request.recording
                      ? calibrate_recorded(*request.recording, ports, options, progress)
                      : calibrate_live(ports, options, progress);

    const auto start = std::chrono::steady_clock::now();
    if (request.projector && request.product) {
        result.geometry = projector_irradiance(request.product->mesh, *request.projector, progress);
        progress.check_stop();
        result.calibration = predict_hidden(std::move(result.live.calibration), result.geometry);
    } else {
        result.calibration = std::move(result.live.calibration);
    }
    result.predict_seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return result;
}

BenchCalibration calibrate_through_ports(Bench& bench,
                                         std::shared_ptr<const Product> product,
                                         const Progress& progress) {
    const BenchDescription& description = bench.description();
    const View& said = description.projector.view;
    BenchCalibrationRequest request;
    request.made_with = "simulated bench " + description.name;
    request.projector = said;
    request.width = said.width;
    request.height = said.height;
    request.product = std::move(product);
    std::optional<RoomPose> room;
    if (description.data_sheets) {
        room = find_room(bench.ports(),
                         said.width,
                         said.height,
                         *description.data_sheets,
                         *request.product,
                         progress.part(0.0, 0.5));
        if (room->registration.free.count == 3) take_turn_of(said, *room);
        request.projector = room->projector;
        request.map = room->map;
    }
    BenchCalibration result =
        calibrate_through_ports(bench.ports(), request, room ? progress.part(0.5, 1.0) : progress);
    result.room = std::move(room);
    return result;
}

}  // namespace livery
