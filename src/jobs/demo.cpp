#include "jobs/demo.h"

#include <chrono>

#include "core/error.h"
#include "core/image_io.h"
#include "core/paths.h"
#include "jobs/demo_sphere.h"
#include "jobs/demo_stages.h"
#include "jobs/eye_comparison.h"
#include "jobs/report.h"
#include "radiance/renderer.h"
#include "scene/library.h"

namespace livery {

namespace {

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
    result.seconds.emplace_back(
        "total", std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
    write_report(result.report, result);
    write_json_file(options.out / "report.json", figures_of(result));
    return result;
}

}  // namespace livery
