#include "jobs/demo.h"

#include <algorithm>
#include <cctype>
#include <chrono>
#include <cmath>

#include <glm/matrix.hpp>

#include "calibration/colour/colour.h"
#include "calibration/predict.h"
#include "core/colour.h"
#include "core/error.h"
#include "core/image_io.h"
#include "core/parallel.h"
#include "core/paths.h"
#include "core/time.h"
#include "jobs/calibrate/bench_calibration.h"
#include "jobs/calibrate/calibration_folder.h"
#include "jobs/comparison.h"
#include "jobs/report.h"
#include "radiance/renderer.h"
#include "scene/library.h"
#include "scene/mockup_mask.h"
#include "twin/painted_sphere.h"
#include "twin/sensor.h"

namespace livery {

namespace {

/// The paper's order: three solid, three metallic.
const std::vector<std::string> kPaints = {
    "solid-red", "solid-green", "solid-blue", "metallic-silver", "metallic-green", "metallic-blue"};

/// A key light from the upper left in front and a weaker fill, both neutral; no environment: the
/// paper's samples were lit by one lamp in a dark room.
std::vector<DirectionalLight> sample_lights() {
    DirectionalLight key;
    key.direction = glm::normalize(glm::dvec3(-0.45, 0.75, 0.55));
    key.angle_rad = 0.05;
    DirectionalLight fill;
    fill.direction = glm::normalize(glm::dvec3(0.75, 0.35, 0.6));
    fill.radiance_rec709 = glm::dvec3(0.25);
    fill.angle_rad = 0.05;
    return {key, fill};
}

ImageF scaled(ImageF image, double factor) {
    for (float& value : image.values) value *= static_cast<float>(factor);
    return image;
}

/// For each spectrally painted sample: its spectral colour at the eye under the looks' lights is
/// the truth, the render of its RGB material is what is projected.
void judge_painted_spheres(DemoResult& result,
                           const CalibratedBench& calibrated,
                           const DemoOptions& options,
                           StageTimes& times,
                           const Progress& progress) {
    const BenchDescription& description = calibrated.bench->description();
    const Mesh& mesh = calibrated.product->mesh;
    const Tracer tracer(mesh);
    RadianceRenderer renderer(calibrated.product, calibrated.projector, progress);

    Scene scene;
    scene.product = calibrated.product;
    scene.lights = sample_lights();
    scene.eye_in_world_mm = description.eye_mm;
    double done = 0.0;
    for (const std::string& name : kPaints) {
        progress.update(done / static_cast<double>(kPaints.size()), "judging " + name);
        done += 1.0;
        const SpectralPaint paint = read_spectral_paint(name);
        scene.part_materials.assign(mesh.parts.size(), material_of(paint));
        FramePlan plan = plan_frame(scene, Quality::normal, FrameStage::radiance);
        timed(times, "render", [&] { renderer.render(scene, plan, progress); });
        WantedLook wanted;
        wanted.working = renderer.read_back();
        const auto sample_in = [&](const View& view) {
            return scaled(
                paint_radiance_xyz(
                    mesh, tracer, view, description.eye_mm, paint, scene.lights, 4, progress),
                calibrated.design_white_y);
        };
        timed(times, "paint the sample", [&] {
            wanted.xyz = sample_in(calibrated.projector);
            wanted.eye_xyz = sample_in(calibrated.bench->eye().view);
        });
        DesignResult design = judge_design(paint.name, wanted, calibrated, options.out, times);
        // What was wanted is the sample itself.
        auto sample = design.pictures.extract("wanted");
        sample.key() = "sample";
        design.pictures.insert(std::move(sample));
        result.designs.push_back(std::move(design));
    }
}

/// Two solid and two metallic paints, as in the paper's case study.
const std::vector<std::string> kDemoLooks = {
    "solid-red", "solid-ivory", "silver-metallic", "blue-metallic"};

void judge_looks(DemoResult& result,
                 const CalibratedBench& calibrated,
                 const DemoOptions& options,
                 StageTimes& times,
                 const Progress& progress) {
    const BenchDescription& description = calibrated.bench->description();
    RadianceRenderer renderer(calibrated.product, calibrated.projector, progress);
    RadianceRenderer eye_renderer(calibrated.product, calibrated.bench->eye().view, progress);
    double done = 0.0;
    std::shared_ptr<const Environment> environment;
    for (const std::string& name : kDemoLooks) {
        progress.update(done / static_cast<double>(kDemoLooks.size()), "judging " + name);
        const Look look = find_look_for(name, part_names(calibrated.product->mesh));
        Scene scene = timed(times, "load the looks", [&] {
            return make_scene(calibrated.product, look, description.eye_mm, environment);
        });
        // Colours are judged. Each flake is a pixel, which a camera and the eye's picture blur
        for (Material& paint : scene.part_materials) paint.glint_density_per_mm2 = 0.0;
        environment = scene.environment;
        FramePlan plan = plan_frame(scene, Quality::normal, FrameStage::radiance);
        StageTimes shading;
        timed(shading, "shade", [&] { renderer.render(scene, plan, progress); });
        times.add("render", shading.all().front().second);
        WantedLook wanted;
        wanted.working = renderer.read_back();
        wanted.xyz = xyz_from_wanted(wanted.working, calibrated.design_white_y);
        // The eye's own picture of the product, which knows nothing of the projector.
        FramePlan eye_plan = plan_frame(scene, Quality::normal, FrameStage::radiance);
        timed(times, "render for the eye", [&] {
            eye_renderer.render(scene, eye_plan, progress);
            wanted.eye_xyz = xyz_from_wanted(eye_renderer.read_back(), calibrated.design_white_y);
        });
        DesignResult design = judge_design(look.name, wanted, calibrated, options.out, times);
        for (const PlannedPass& pass : plan.passes) {
            const PassKind kind = pass.id.kind;
            if (pass.ms && (kind == PassKind::shade || kind == PassKind::resolve)) {
                design.shade_ms += *pass.ms;
            }
        }
        result.designs.push_back(std::move(design));
        done += 1.0;
    }
}

}  // namespace

DemoResult run_demo(const DemoOptions& options, const Progress& progress) {
    const auto start = std::chrono::steady_clock::now();
    make_output_folder(options.out / "pictures");
    // A stop must not leave an older report over newer pictures.
    std::filesystem::remove(options.out / "report.html");
    std::filesystem::remove(options.out / "report.json");
    StageTimes times;

    const bool sphere = options.product == "sphere";
    BenchDescription description = read_bench_file(
        options.bench == "default" ? *bench_of_shipped_product(options.product) : options.bench);
    View& projector = description.projector.view;
    if (options.size_px.x > 0) projector = resized(projector, options.size_px.x, options.size_px.y);
    description.seed = options.seed;
    const auto product = timed(
        times, "load the product", [&] { return find_product(description.product.string()); });

    // Before anything slow: a missing driver is said at once. Current until the end.
    const HeadlessContext context(options.gl_device);
    const CalibratedBench calibrated =
        calibrate_bench(options, description, product, times, progress);
    DemoResult result;
    result.renderer = context.renderer();
    result.bench_name = description.name;
    result.product_name = product->name;
    result.room = calibrated.room;
    result.picture_off_px = picture_offset(description.projector.view,
                                           product->mesh,
                                           calibrated.projector,
                                           product->mesh,
                                           calibrated.bench->truth().lit);
    result.design_white_y = calibrated.design_white_y;
    const Image8& lit = calibrated.bench->truth().lit;
    const PixelRectangle box = bounds_of_mask(lit, 0);
    result.mockup_length_px = box.right - box.left;
    std::size_t covered = 0;
    for (const auto value : lit.values) covered += value != 0;
    result.covered_fraction = static_cast<double>(covered) / static_cast<double>(lit.values.size());

    if (sphere) {
        judge_painted_spheres(result, calibrated, options, times, progress);
    } else {
        judge_looks(result, calibrated, options, times, progress);
    }

    write_png(options.out / "pictures/difference-legend.png", difference_legend(320, 16));
    result.calibration = calibrated.calibration;
    for (ImageF* plane : {&result.calibration.unmixing,
                          &result.calibration.dark,
                          &result.calibration.span,
                          &result.calibration.camera_px}) {
        *plane = ImageF();
    }
    result.report = options.out / "report.html";
    result.seconds = times.all();
    result.seconds.emplace_back("total", seconds_since(start));
    write_report(result.report, result);
    write_json_file(options.out / "report.json", figures_of(result));
    return result;
}

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

    CalibrationResult calibrated =
        calibrate_through_ports(result.bench->ports(), settings_of(description, product), progress);
    result.room = std::move(calibrated.room);
    result.projector = *calibrated.projector;
    if (result.room) {
        times.add("photograph the Gray code", result.room->seen.captured.all);
        times.add("find where everything stands", result.room->solve_seconds);
    }
    times.add("photograph the patterns", calibrated.captured.all);
    times.add("solve the calibration", calibrated.solve_seconds);
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
        CalibrationSettings with_chart;
        with_chart.made_with = result.calibration.made_with;
        with_chart.camera_to_xyz.xyz_from_camera = chart_matrix(description, result.calibration);
        with_chart.camera_to_xyz.origin = "chart";
        const ColourCalibration by_chart = predict_hidden(
            calibrate_colour(
                calibrated.captures, calibrated.patterns, calibrated.map, with_chart, progress),
            calibrated.irradiance);
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
