#include "jobs/bench_calibration.h"

#include <chrono>
#include <utility>

#include "calibration/predict.h"
#include "jobs/capture_run.h"
#include "jobs/projector_irradiance.h"
#include "scene/mockup_mask.h"

namespace livery {

namespace {

/// Of each colour picture, mosaics included: a second photograph takes a third of their noise away,
/// and makes a calibration of some fifty photographs a tenth longer.
constexpr int kColourShots = 2;

}  // namespace

LiveOptions live_options_of(const BenchCalibrationRequest& request) {
    LiveOptions options;
    options.shots = kColourShots;
    options.width = request.width;
    options.height = request.height;
    options.colour.made_with = request.made_with;
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
    BenchCalibrationRequest request;
    request.made_with = "simulated bench " + bench.description().name;
    request.projector = bench.description().projector.view;
    request.width = request.projector->width;
    request.height = request.projector->height;
    request.product = std::move(product);
    return calibrate_through_ports(bench.ports(), request, progress);
}

}  // namespace livery
