#include "jobs/demo_sphere.h"

#include "core/parallel.h"
#include "radiance/renderer.h"
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

}  // namespace

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

}  // namespace livery
