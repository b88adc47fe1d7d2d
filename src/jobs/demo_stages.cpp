#include "jobs/demo_stages.h"

#include <algorithm>
#include <cctype>
#include <cmath>

#include <glm/matrix.hpp>

#include "calibration/predict.h"
#include "core/colour.h"
#include "core/error.h"
#include "core/image_io.h"
#include "jobs/calibrate/bench_calibration.h"
#include "jobs/calibrate/calibration_folder.h"
#include "jobs/comparison.h"
#include "scene/mockup_mask.h"
#include "twin/sensor.h"

namespace livery {

namespace {

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
        return std::make_unique<Bench>(description, product, progress, EyePicture::traced);
    });

    BenchCalibration calibrated = calibrate_through_ports(*result.bench, product, progress);
    result.room = std::move(calibrated.room);
    result.projector = *calibrated.projector;
    if (result.room) {
        times.add("photograph the Gray code", result.room->capture_seconds);
        times.add("find where everything stands", result.room->solve_seconds);
    }
    times.add("photograph the patterns", calibrated.live.capture_seconds);
    times.add("solve the calibration", calibrated.live.solve_seconds);
    times.add("predict hidden pixels", calibrated.predict_seconds);
    result.calibration = std::move(calibrated.calibration);
    result.valid = corrected_pixels(result.calibration);
    result.predicted = corrected_pixels(result.calibration, true);

    timed(times, "write the calibration", [&] {
        write_setup(options.out / "calibration", result.calibration, result.projector);
    });

    result.design_white_y = design_white_luminance(result.calibration,
                                                   options.design_white_percentile,
                                                   mockup_mask(product->mesh, result.projector));
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

namespace {

/// What is projected of one design.
struct Drives {
    Image8 corrected, uncorrected;
    std::optional<Image8> chart_corrected;
};

template <typename Observe>
JudgedPictures judged(const Drives& drives,
                      const ImageF& wanted_xyz,
                      const ComparisonMasks& masks,
                      double design_white_y,
                      StageTimes& times,
                      const Observe& observe) {
    const auto compared = [&](const Image8& drive) {
        const ImageF shown_xyz = timed(times, "observe", [&] { return observe(drive); });
        return timed(times, "compare", [&] {
            return compare_xyz(wanted_xyz, shown_xyz, design_white_y * d65_xyz(), masks);
        });
    };
    JudgedPictures result;
    result.corrected = compared(drives.corrected);
    result.uncorrected = compared(drives.uncorrected);
    if (drives.chart_corrected) result.chart_corrected = compared(*drives.chart_corrected);
    return result;
}

double unlit_fraction(const ObserverTruth& eye) {
    std::size_t seen = 0, dark = 0;
    for (std::size_t i = 0; i < eye.seen_by_eye.values.size(); ++i) {
        seen += eye.seen_by_eye.values[i] != 0;
        dark += eye.seen_by_eye.values[i] != 0 && eye.lit.values[i] == 0;
    }
    return seen == 0 ? 0.0 : static_cast<double>(dark) / static_cast<double>(seen);
}

}  // namespace

DesignResult judge_design(const std::string& name,
                          const WantedLook& wanted,
                          const CalibratedBench& calibrated,
                          const std::filesystem::path& out,
                          StageTimes& times) {
    const Bench& bench = *calibrated.bench;
    DesignResult result;
    result.name = name;

    CompensationStats stats;
    StageTimes compensation_time;
    Drives drives;
    drives.corrected = timed(compensation_time, "compensate", [&] {
        return compensate(calibrated.table, wanted.working, &stats);
    });
    result.compensate_ms = 1000.0 * compensation_time.all().front().second;
    times.add("compensate", compensation_time.all().front().second);
    result.out_of_gamut_fraction = stats.out_of_gamut_fraction;
    drives.uncorrected = srgb_from_working(wanted.working);
    if (calibrated.chart_table) {
        drives.chart_corrected = compensate(*calibrated.chart_table, wanted.working);
    }

    // What the audience sees, by the bench's spectral observer.
    ComparisonMasks masks{
        bench.truth().lit, bench.truth().edge, calibrated.valid, {}, calibrated.predicted};
    masks.reachable = timed(times, "observe", [&] { return bench.reachable(wanted.xyz); });
    result.pixels =
        judged(drives, wanted.xyz, masks, calibrated.design_white_y, times, [&](const auto& drive) {
            return bench.observe_xyz(drive);
        });
    masks = timed(times, "observe", [&] {
        return masks_of_eye(bench, calibrated.valid, calibrated.predicted, wanted.eye_xyz);
    });
    result.seen = judged(
        drives, wanted.eye_xyz, masks, calibrated.design_white_y, times, [&](const auto& drive) {
            return bench.observe_from_eye(drive);
        });
    result.unlit_fraction = unlit_fraction(bench.eye().observer.truth);

    // What the camera photographs of the corrected and the uncorrected picture.
    const BenchPorts ports = calibrated.bench->ports();
    const auto photograph = [&](const Image8& drive) {
        return timed(times, "project and photograph", [&] {
            ports.show(drive);
            return developed(ports.photograph(0.0), calibrated.calibration.xyz_from_camera);
        });
    };
    const ImageF corrected_photo = photograph(drives.corrected);
    const ImageF uncorrected_photo = photograph(drives.uncorrected);

    timed(times, "write the pictures", [&] {
        const PixelRectangle seen = bright_part(corrected_photo, calibrated.design_white_y);
        const auto picture = [&](const std::string& what, const Image8& image) {
            const std::filesystem::path file = "pictures/" + slug(name) + "-" + what + ".png";
            write_png(out / file, image);
            result.pictures[what] = file;
        };
        const auto at_eye = [&](const ImageF& xyz) {
            return srgb_from_xyz(xyz, calibrated.design_white_y);
        };
        const auto seen_photo = [&](const ImageF& xyz) {
            return crop(srgb_from_xyz(xyz, calibrated.design_white_y), seen);
        };
        picture("wanted", at_eye(wanted.eye_xyz));
        picture("uncorrected", at_eye(bench.observe_from_eye(drives.uncorrected)));
        picture("corrected", at_eye(bench.observe_from_eye(drives.corrected)));
        picture("difference", difference_map(result.seen.corrected.de00, 5.0));
        picture("photograph-corrected", seen_photo(corrected_photo));
        picture("photograph-uncorrected", seen_photo(uncorrected_photo));
        write_png(out / ("pictures/" + slug(name) + "-projector-input.png"), drives.corrected);
    });
    return result;
}

}  // namespace livery
