#include "jobs/bench_calibration.h"

#include <chrono>

#include "calibration/predict.h"
#include "jobs/projector_irradiance.h"
#include "scene/mockup_mask.h"

namespace livery {

namespace {

/// Of each colour picture, mosaics included: a second photograph takes a third of their noise away,
/// and makes a calibration of some fifty photographs a tenth longer.
constexpr int kColourShots = 2;

}  // namespace

BenchCalibration calibrate_through_ports(Bench& bench,
                                         const Product& product,
                                         const Progress& progress) {
    const View& projector = bench.description().projector.view;
    LiveOptions options;
    options.shots = kColourShots;
    options.width = projector.width;
    options.height = projector.height;
    options.colour.made_with = "simulated bench " + bench.description().name;
    options.mockup = mockup_mask(product.mesh, projector);
    BenchCalibration result;
    result.live = calibrate_live(bench.ports(), options, progress);

    const auto start = std::chrono::steady_clock::now();
    result.geometry = projector_irradiance(product.mesh, projector, progress);
    progress.check_stop();
    result.calibration = predict_hidden(std::move(result.live.calibration), result.geometry);
    result.predict_seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return result;
}

}  // namespace livery
