#include "jobs/calibrate/bench_calibration.h"

#include <chrono>
#include <utility>

#include "calibration/predict.h"
#include "jobs/capture_bench.h"
#include "jobs/captured_calibration.h"
#include "scene/mockup_mask.h"

namespace livery {

LiveOptions live_options_of(const BenchCalibrationRequest& request) {
    LiveOptions options;
    options.shots = request.colour_shots;
    options.width = request.width;
    options.height = request.height;
    options.colour.mode = request.mode;
    options.colour.made_with = request.made_with;
    options.places = request.places;
    options.map = request.map;
    if (request.camera_to_xyz) options.colour.camera_to_xyz = *request.camera_to_xyz;
    if (request.projector && request.product)
        options.mockup = request.lit.empty()
                             ? mockup_mask(request.product->mesh, *request.projector)
                             : request.lit;
    return options;
}

bool finds_room(const BenchCalibrationRequest& request) {
    return !request.projector && request.data_sheets && request.product;
}

RoomPose find_room_for(const BenchPorts& ports,
                       const BenchCalibrationRequest& request,
                       const Progress& progress) {
    RoomPose room;
    const auto find = [&](const BenchPorts& through, const std::filesystem::path& checkpoint) {
        room = find_room(through,
                         request.width,
                         request.height,
                         *request.data_sheets,
                         *request.product,
                         progress,
                         checkpoint,
                         request.places);
    };
    if (Recording* recording = request.room_recording) {
        const std::filesystem::path& folder = recording->folder();
        const PortSeconds seconds = run_recorded(
            *recording, ports, [&](const BenchPorts& kept) { find(kept, folder / "room.json"); });
        room.camera_seconds = seconds.camera;
        room.projector_seconds = seconds.projector;
        recording->write_manifest(request.width, request.height, room.kept);
        write_map(folder / "map.exr", room.map);
    } else {
        find(ports, {});
    }
    if (request.turned_as) take_turn_of(*request.turned_as, room.geometry);
    return room;
}

BenchCalibrationRequest with_room(BenchCalibrationRequest request, const RoomPose& room) {
    request.projector = room.geometry.projector;
    request.map = room.map;
    return request;
}

BenchCalibration calibrate_through_ports(const BenchPorts& ports,
                                         const BenchCalibrationRequest& request,
                                         const Progress& progress) {
    if (finds_room(request)) {
        RoomPose room = find_room_for(ports, request, progress.part(0.0, 0.5));
        BenchCalibration result =
            calibrate_through_ports(ports, with_room(request, room), progress.part(0.5, 1.0));
        result.room = std::move(room);
        return result;
    }
    const LiveOptions options = live_options_of(request);
    BenchCalibration result;
    result.projector = request.projector;
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

BenchCalibrationRequest request_of(const BenchDescription& description,
                                   std::shared_ptr<const Product> product) {
    const View& said = description.projector.view;
    BenchCalibrationRequest request;
    request.made_with = "simulated bench " + description.name;
    request.width = said.width;
    request.height = said.height;
    request.product = std::move(product);
    request.data_sheets = description.data_sheets;
    if (description.data_sheets) {
        request.turned_as = said;
    } else {
        request.projector = said;
    }
    return request;
}

BenchCalibration calibrate_through_ports(Bench& bench,
                                         std::shared_ptr<const Product> product,
                                         const Progress& progress) {
    return calibrate_through_ports(
        bench.ports(), request_of(bench.description(), std::move(product)), progress);
}

}  // namespace livery
