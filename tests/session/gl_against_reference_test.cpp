// The renderer against the path tracer: the same scene in, the same picture out, direct light only.
// Limits for lamps, set before looking: the median within 2% and the 99th percentile within 10% of
// design white (radiance 1), at mirror-smooth lobes (alpha .02) and at wide ones. An
// environment is held to the same 99th percentile and to a median of 3%.

#include <gtest/gtest.h>

#include "gl/context.h"
#include "radiance/accuracy.h"
#include "reference/path_tracer.h"
#include "session/library.h"
#include "session/render.h"
#include "twin/description.h"

namespace livery {
namespace {

constexpr double kMedian = 0.02;
constexpr double kP99 = 0.10;
constexpr double kEnvironmentMedian = 0.03;

Material coated(double alpha) {
    Material material;
    material.name = "coated";
    material.model = ReflectanceModel::clearcoat;
    material.diffuse = glm::dvec3(0.3, 0.05, 0.04);
    material.f0 = glm::dvec3(0.2, 0.1, 0.1);
    material.alpha = glm::dvec2(0.25);
    material.coat_alpha = alpha;
    return material;
}

Material glossy(double alpha) {
    Material material;
    material.name = "glossy";
    material.model = ReflectanceModel::ggx;
    material.diffuse = glm::dvec3(0.05, 0.2, 0.3);
    material.f0 = glm::dvec3(0.3);
    material.alpha = glm::dvec2(alpha);
    return material;
}

/// Flakes in two lobes, each of another colour.
Material flaked(double alpha) {
    Material material;
    material.name = "flaked";
    material.model = ReflectanceModel::car_paint;
    material.diffuse = glm::dvec3(0.02, 0.03, 0.08);
    material.f0 = glm::dvec3(0.06, 0.08, 0.1);
    material.alpha = glm::dvec2(0.12);
    material.flake_f0 = glm::dvec3(0.08, 0.12, 0.2);
    material.flake_alpha = 0.3;
    material.coat_alpha = alpha;
    return material;
}

enum class Light { lamps, environment };

/// The path tracer's samples a pixel: its own noise must stay well under the limits, and light from
/// all directions is noisier than two lamps.
int samples_for(Light light) { return light == Light::lamps ? 64 : 768; }

RadianceError error_of(const std::string& bench_name,
                       const Material& paint,
                       Light light,
                       const View& view) {
    const BenchDescription bench = read_bench_file(bench_name);
    const auto product = find_product(bench.product.string());
    Look look = find_look("solid-red");
    look.parts.clear();
    Scene scene = make_scene(product, look, bench.eye_mm);
    scene.part_materials.assign(product->mesh.parts.size(), paint);
    scene.exposure_ev = 0.0;
    if (light == Light::lamps) scene.environment = nullptr;
    if (light == Light::environment) scene.lights.clear();

    RenderRequest request;
    request.scene = scene;
    request.view = view;
    request.gl_device = GlDevice::software;
    const RenderedFrame drawn = render_frame(request);
    ReferenceOptions options;
    options.samples_per_pixel = samples_for(light);
    const ReferenceResult truth = trace_reference(scene, request.view, options);
    const RadianceError error = radiance_error(drawn.radiance_working, truth.radiance_working);
    std::printf("%s, %s, alpha %.2f, %s: median %.4f, 90%% %.4f, 99%% %.4f over %zu pixels\n",
                bench_name.c_str(),
                paint.name.c_str(),
                paint.model == ReflectanceModel::ggx ? paint.alpha.x : paint.coat_alpha,
                light == Light::lamps ? "lamps" : "environment",
                error.median,
                error.p90,
                error.p99,
                error.pixels);
    return error;
}

void expect_close(const RadianceError& error, double median, double p99) {
    EXPECT_GT(error.pixels, 900u);
    EXPECT_LT(error.median, median);
    EXPECT_LT(error.p99, p99);
}

/// A part of the picture at its own scale: what a pixel covers decides how hard a highlight is.
View part_of(const View& view, glm::ivec2 corner_px, glm::ivec2 size_px) {
    return cropped(view, corner_px.x, corner_px.y, size_px.x, size_px.y);
}

View sphere_view() { return read_bench_file("sphere").projector.view; }
View car_view() { return read_bench_file("default").projector.view; }

// The upper left of the sphere with a lamp's reflection and the silhouette.
constexpr glm::ivec2 kSphereCorner{340, 100}, kSphereSky{100, 60};
// The car's bonnet and wing with a joint.
constexpr glm::ivec2 kCarCorner{680, 470}, kCarLamps{200, 130}, kCarSky{100, 64};

TEST(GlAgainstReference, SphereUnderLamps) {
    for (const Material& paint : {coated(0.02), flaked(0.02), glossy(0.02), glossy(0.3)}) {
        expect_close(error_of("sphere", paint, Light::lamps, resized(sphere_view(), 160, 100)),
                     kMedian,
                     kP99);
    }
}

TEST(GlAgainstReference, SphereInAnEnvironment) {
    for (const Material& paint : {coated(0.02), flaked(0.02), glossy(0.3)}) {
        expect_close(error_of("sphere",
                              paint,
                              Light::environment,
                              part_of(sphere_view(), kSphereCorner, kSphereSky)),
                     kEnvironmentMedian,
                     kP99);
    }
}

TEST(GlAgainstReference, CarUnderLamps) {
    for (const Material& paint : {coated(0.02), flaked(0.02), glossy(0.02), glossy(0.3)}) {
        expect_close(
            error_of("default", paint, Light::lamps, part_of(car_view(), kCarCorner, kCarLamps)),
            kMedian,
            kP99);
    }
}

TEST(GlAgainstReference, CarInAnEnvironment) {
    for (const Material& paint : {coated(0.02), flaked(0.02), glossy(0.3)}) {
        expect_close(
            error_of(
                "default", paint, Light::environment, part_of(car_view(), kCarCorner, kCarSky)),
            kEnvironmentMedian,
            kP99);
    }
}

}  // namespace
}  // namespace livery
