#include "jobs/demo_stages.h"

#include <algorithm>
#include <cctype>
#include <cmath>

#include <glm/matrix.hpp>

#include "calibration/predict.h"
#include "core/colour.h"
#include "core/error.h"
#include "core/image_io.h"
#include "jobs/bench_calibration.h"
#include "jobs/calibration_folder.h"
#include "scene/mockup_mask.h"
#include "twin/chart.h"

namespace livery {

namespace {

template <typename Holds>
Image8 mask_of(const ColourCalibration& calibration, const Holds& holds) {
    Image8 mask(calibration.width, calibration.height, 1);
    for (std::size_t i = 0; i < mask.values.size(); ++i) {
        mask.values[i] = holds(static_cast<PixelStatus>(calibration.status.values[i])) ? 255 : 0;
    }
    return mask;
}

/// A camera matrix as most people make it: from a chart under daylight. A chart has no absolute
/// scale, so D65 is given the luminance that the measured primaries give it.
glm::dmat3 chart_matrix(const BenchDescription& description, const ColourCalibration& measured) {
    const ChartPhotograph chart = photograph_chart_under_daylight(description.camera);
    const glm::dmat3 fitted = fit_camera_matrix(chart.camera_rgb, chart.xyz);
    const glm::dvec3 camera_of_d65 = glm::inverse(measured.xyz_from_camera) * d65_xyz();
    return fitted * (1.0 / (fitted * camera_of_d65).y);
}

std::string slug(const std::string& name) {
    std::string text;
    for (const char c : name) {
        text += std::isalnum(static_cast<unsigned char>(c))
                    ? static_cast<char>(std::tolower(static_cast<unsigned char>(c)))
                    : '-';
    }
    return text;
}

/// The part of a photograph that is brighter than its background.
PixelRectangle bright_part(const ImageF& xyz, double white_y) {
    Image8 mask(xyz.width, xyz.height, 1);
    for (std::size_t i = 0; i < mask.values.size(); ++i) {
        mask.values[i] = static_cast<double>(xyz.values[3 * i + 1]) > 0.02 * white_y ? 255 : 0;
    }
    return bounds_of_mask(mask, 12);
}

}  // namespace

void StageTimes::add(const std::string& stage, double seconds) {
    const auto known = std::find_if(
        stages_.begin(), stages_.end(), [&](const auto& entry) { return entry.first == stage; });
    if (known != stages_.end()) {
        known->second += seconds;
    } else {
        stages_.emplace_back(stage, seconds);
    }
}

CalibratedBench calibrate_bench(const DemoOptions& options,
                                const BenchDescription& description,
                                std::shared_ptr<const Product> product,
                                StageTimes& times,
                                const Progress& progress) {
    CalibratedBench result;
    result.product = product;
    result.bench = timed(times, "set up the bench", [&] {
        return std::make_unique<Bench>(description, product, progress);
    });

    BenchCalibration calibrated = calibrate_through_ports(*result.bench, product, progress);
    times.add("photograph the patterns", calibrated.live.capture_seconds);
    times.add("solve the calibration", calibrated.live.solve_seconds);
    times.add("predict hidden pixels", calibrated.predict_seconds);
    result.calibration = std::move(calibrated.calibration);
    result.valid = mask_of(result.calibration, is_valid);
    result.predicted = mask_of(result.calibration,
                               [](PixelStatus status) { return status == PixelStatus::predicted; });

    timed(times, "write the calibration", [&] {
        write_setup(options.out / "calibration", result.calibration, description.projector.view);
    });

    result.design_white_y =
        design_white_luminance(result.calibration,
                               options.design_white_percentile,
                               mockup_mask(product->mesh, description.projector.view));
    result.table = bake(result.calibration, result.design_white_y);

    timed(times, "solve again with the chart's matrix", [&] {
        ColourOptions with_chart;
        with_chart.made_with = result.calibration.made_with;
        with_chart.camera_to_xyz.xyz_from_camera = chart_matrix(description, result.calibration);
        with_chart.camera_to_xyz.origin = "chart";
        const ColourCalibration by_chart = predict_hidden(calibrate_colour(calibrated.live.captures,
                                                                           calibrated.live.patterns,
                                                                           calibrated.live.map,
                                                                           with_chart,
                                                                           progress),
                                                          calibrated.geometry);
        result.chart_table = bake(by_chart, result.design_white_y);
    });
    return result;
}

DesignResult judge_design(const std::string& name,
                          const ImageF& wanted_working,
                          const ImageF& wanted_xyz,
                          const CalibratedBench& calibrated,
                          const std::filesystem::path& out,
                          StageTimes& times) {
    const Bench& bench = *calibrated.bench;
    const glm::dvec3 white_xyz = calibrated.design_white_y * d65_xyz();
    DesignResult result;
    result.name = name;

    CompensationStats stats;
    StageTimes compensation_time;
    const Image8 corrected_drive = timed(compensation_time, "compensate", [&] {
        return compensate(calibrated.table, wanted_working, &stats);
    });
    result.compensate_ms = 1000.0 * compensation_time.all().front().second;
    times.add("compensate", compensation_time.all().front().second);
    result.out_of_gamut_fraction = stats.out_of_gamut_fraction;
    const Image8 uncorrected_drive = srgb_from_working(wanted_working);

    // What the audience sees, by the bench's spectral observer.
    const ImageF corrected_xyz =
        timed(times, "observe", [&] { return bench.observe_xyz(corrected_drive); });
    const ImageF uncorrected_xyz =
        timed(times, "observe", [&] { return bench.observe_xyz(uncorrected_drive); });
    ComparisonMasks masks{
        bench.truth().lit, bench.truth().edge, calibrated.valid, {}, calibrated.predicted};
    masks.reachable = timed(times, "observe", [&] { return bench.reachable(wanted_xyz); });
    timed(times, "compare", [&] {
        result.corrected = compare_xyz(wanted_xyz, corrected_xyz, white_xyz, masks);
        result.uncorrected = compare_xyz(wanted_xyz, uncorrected_xyz, white_xyz, masks);
    });
    if (calibrated.chart_table) {
        const ImageF chart_xyz = timed(times, "observe", [&] {
            return bench.observe_xyz(compensate(*calibrated.chart_table, wanted_working));
        });
        result.chart_corrected = timed(
            times, "compare", [&] { return compare_xyz(wanted_xyz, chart_xyz, white_xyz, masks); });
    }

    // What the camera photographs of the corrected and the uncorrected picture.
    const BenchPorts ports = calibrated.bench->ports();
    const auto photograph = [&](const Image8& drive) {
        return timed(times, "project and photograph", [&] {
            ports.show(drive);
            return developed(ports.photograph(0.0), calibrated.calibration.xyz_from_camera);
        });
    };
    const ImageF corrected_photo = photograph(corrected_drive);
    const ImageF uncorrected_photo = photograph(uncorrected_drive);

    timed(times, "write the pictures", [&] {
        const PixelRectangle car = bounds_of_mask(masks.lit, 12);
        const PixelRectangle seen = bright_part(corrected_photo, calibrated.design_white_y);
        const auto picture = [&](const std::string& what, const Image8& image) {
            const std::filesystem::path file = "pictures/" + slug(name) + "-" + what + ".png";
            write_png(out / file, image);
            result.pictures[what] = file;
        };
        const auto shown = [&](const ImageF& xyz) {
            return crop(srgb_from_xyz(xyz, calibrated.design_white_y), car);
        };
        const auto seen_photo = [&](const ImageF& xyz) {
            return crop(srgb_from_xyz(xyz, calibrated.design_white_y), seen);
        };
        picture("wanted", shown(wanted_xyz));
        picture("uncorrected", shown(uncorrected_xyz));
        picture("corrected", shown(corrected_xyz));
        picture("difference", crop(difference_map(result.corrected.de00, 5.0), car));
        picture("photograph-corrected", seen_photo(corrected_photo));
        picture("photograph-uncorrected", seen_photo(uncorrected_photo));
        write_png(out / ("pictures/" + slug(name) + "-projector-input.png"), corrected_drive);
    });
    return result;
}

}  // namespace livery
