#include "jobs/demo.h"

#include <chrono>

#include "core/error.h"
#include "core/image_io.h"
#include "core/parallel.h"
#include "core/paths.h"
#include "jobs/comparison.h"
#include "jobs/demo_stages.h"
#include "jobs/report.h"
#include "radiance/renderer.h"
#include "scene/library.h"
#include "twin/painted_sphere.h"

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
    result.seconds.emplace_back(
        "total", std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
    write_report(result.report, result);
    write_json_file(options.out / "report.json", figures_of(result));
    return result;
}

}  // namespace livery
