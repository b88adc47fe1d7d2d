// The renderer against the path tracer: the same scene in, the same picture out, direct light only.
// Limits for lamps, set before looking: the median within 2% and the 99th percentile within 10% of
// design white (radiance 1), at mirror-smooth lobes (alpha .02) and at wide ones. An
// environment is held to the same 99th percentile and to a median of 3%.

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/worst_error.h"
#include "gl/context.h"
#include "jobs/render/render.h"
#include "scene/library.h"
#include "support/direct_levels.h"
#include "support/gl_device.h"
#include "support/kept_truth.h"
#include "support/radiance_error.h"
#include "tracing/tracer.h"
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
    request.levels = direct_levels(Quality::normal);
    request.scene = scene;
    request.view = view;
    request.gl_device = tested_gl();
    const RenderedFrame drawn = render_frame(request);
    ReferenceOptions options;
    options.bounces = 0;  // as direct_levels()
    options.samples_per_pixel = samples_for(light);
    const ImageF truth = testing::kept_truth(
        fmt::format(
            "{}-{}-{}", bench_name, paint.name, light == Light::lamps ? "lamps" : "environment"),
        scene,
        request.view,
        options);
    const RadianceError error = radiance_error(drawn.radiance_working, truth);
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
constexpr glm::ivec2 kCarCorner{680, 470}, kCarLamps{200, 130}, kCarSky{64, 40};

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

/// The car three quarters from the front, from about the height of its roof.
View quarter_view() {
    return look_at({270, 110, 370}, {0, 27, 0}, 2.0 * std::atan(200.0 / 1350.0), 640, 400);
}

/// A window of a picture on one kind of surface of the car.
struct Region {
    std::string name;
    std::vector<glm::ivec2> pixels_px;
    glm::ivec2 corner_px{0};
};

constexpr glm::ivec2 kWindow{20, 12};

/// Of the car in that view: where each kind of surface fills the most of a window.
std::vector<Region> regions_of(const Product& car, const View& view) {
    const Mesh& mesh = car.mesh;
    const Tracer tracer(mesh);
    // The front wheel on this side, as its tyre's corners have it
    glm::vec3 low(1e9f), high(-1e9f);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        if (mesh.parts[mesh.triangle_part[t]].name != "tyres") continue;
        for (int c = 0; c < 3; ++c) {
            const glm::vec3& p = mesh.positions_mm[mesh.triangles[t][c]];
            if (p.x < 0.0f || p.z < 0.0f) continue;
            low = glm::min(low, p);
            high = glm::max(high, p);
        }
    }
    const glm::vec3 wheel = 0.5f * (low + high);
    const float radius = 0.5f * (high.y - low.y);
    const std::vector<std::string> names{"bonnet", "doors", "wheels", "arches", "glass"};
    const auto region_at = [&](int x, int y) -> std::size_t {
        const Ray ray = ray_through(view, glm::dvec2(x + 0.5, y + 0.5));
        const Hit hit =
            tracer.closest({glm::vec3(ray.origin), 0.0f, glm::vec3(ray.direction), 1e30f});
        if (!hit.valid()) return names.size();
        const SurfacePoint at = surface_point(mesh, hit);
        const glm::vec3 p = at.position_mm;
        const std::string& part = mesh.parts[at.part].name;
        if (part == "glass") return 4;
        if (part == "tyres" || part == "rims") return 2;
        if (glm::length(glm::vec2(p - wheel)) < 1.2f * radius && p.z > 0.0f) return 3;
        if (part != "body") return names.size();
        if (at.normal.y > 0.7f && p.x > 40.0f) return 0;
        if (at.normal.z > 0.8f && std::abs(p.x) < 34.0f) return 1;
        return names.size();
    };
    std::vector<std::size_t> of_pixel;
    for (int y = 0; y < view.height; ++y) {
        for (int x = 0; x < view.width; ++x) of_pixel.push_back(region_at(x, y));
    }
    std::vector<Region> regions;
    for (std::size_t k = 0; k < names.size(); ++k) {
        Region most{names[k], {}, {}};
        for (int y = 0; y + kWindow.y <= view.height; y += 2) {
            for (int x = 0; x + kWindow.x <= view.width; x += 2) {
                std::vector<glm::ivec2> inside;
                for (int v = 0; v < kWindow.y; ++v) {
                    for (int u = 0; u < kWindow.x; ++u) {
                        const auto at = static_cast<std::size_t>((y + v) * view.width + x + u);
                        if (of_pixel[at] == k) inside.emplace_back(u, v);
                    }
                }
                if (inside.size() > most.pixels_px.size()) most = {names[k], inside, {x, y}};
            }
        }
        regions.push_back(std::move(most));
    }
    return regions;
}

/// How far the sum over a region may be off, relative.
double allowed_in(const std::string& region, const Material& paint) {
    constexpr double kAsked = 0.02;
    // Between tyre, spokes and arch each fragment looks through gaps of its own, by a hundred rays
    // at most: other neighbours' rays and every second of a ring's stand for those between.
    if (region == "wheels") return 0.04;
    // The fit of a coat's albedo may be .009 too large (microfacet.glsl).
    if (paint.model == ReflectanceModel::clearcoat) return 0.035;
    return kAsked;
}

TEST(GlAgainstReference, RegionsOfTheCarInAnEnvironment) {
    // 2% of each region's mean is asked of the sum over it. Single pixels are the other tests'.
    const auto product = find_product("car");
    const View view = resized(quarter_view(), 320, 200);
    const std::vector<Region> regions = regions_of(*product, view);
    for (const Material& paint : {coated(0.02), flaked(0.02), glossy(0.02), glossy(0.3)}) {
        Look look = find_look("solid-red");
        look.parts.clear();
        Scene scene = make_scene(product, look, {270, 110, 370});
        scene.part_materials.assign(product->mesh.parts.size(), paint);
        scene.exposure_ev = 0.0;
        scene.lights.clear();
        RenderRequest request;
        request.levels = direct_levels(Quality::normal);
        request.scene = scene;
        request.view = view;
        request.gl_device = tested_gl();
        const ImageF drawn = render_frame(request).radiance_working;
        for (const Region& region : regions) {
            ASSERT_GT(region.pixels_px.size(), 60u) << region.name;
            ReferenceOptions options;
            options.bounces = 0;  // as direct_levels()
            // Little light comes by few ways in the wheels: 512 samples leave 1.4%
            options.samples_per_pixel = region.name == "wheels" ? 2048 : 256;
            const glm::ivec2 corner = region.corner_px;
            const ImageF truth =
                testing::kept_truth("car-" + region.name + "-" + paint.name,
                                    scene,
                                    cropped(view, corner.x, corner.y, kWindow.x, kWindow.y),
                                    options);
            double sum = 0.0, true_sum = 0.0;
            for (const glm::ivec2& at : region.pixels_px) {
                for (int c = 0; c < 3; ++c) {
                    sum += static_cast<double>(drawn.at(corner.x + at.x, corner.y + at.y, c));
                    true_sum += static_cast<double>(truth.at(at.x, at.y, c));
                }
            }
            const double off = sum / true_sum - 1.0;
            std::printf("%s, %s, alpha %.2f: %+.4f of %zu pixels\n",
                        region.name.c_str(),
                        paint.name.c_str(),
                        paint.model == ReflectanceModel::ggx ? paint.alpha.x : paint.coat_alpha,
                        off,
                        region.pixels_px.size());
            EXPECT_LT(std::abs(off), allowed_in(region.name, paint))
                << region.name << ", " << paint.name;
        }
    }
}

/// In the first shipped look's light: a lamp 3 degrees wide from above in the studio.
Scene quarter_scene(const Material& paint) {
    const auto product = find_product("car");
    Look look = find_look("solid-red");
    look.parts.clear();
    Scene scene = make_scene(product, look, {270, 110, 370});
    scene.part_materials.assign(product->mesh.parts.size(), paint);
    scene.exposure_ev = 0.0;
    scene.lights.resize(1);
    scene.lights[0].direction = glm::normalize(glm::dvec3(-0.45, 0.75, 0.55));
    scene.lights[0].radiance_rec709 = glm::dvec3(1.0);
    scene.lights[0].angle_rad = 0.05236;
    return scene;
}

ImageF draw(const Scene& scene, const View& view, Quality quality) {
    RenderRequest request;
    request.scene = scene;
    request.view = view;
    request.gl_device = tested_gl();
    request.quality = quality;
    request.levels = direct_levels(quality);
    return render_frame(request).radiance_working;
}

ImageF truth_of(const Scene& scene, const View& view, int samples) {
    ReferenceOptions options;
    options.bounces = 0;  // as direct_levels()
    options.samples_per_pixel = samples;
    return testing::kept_truth(
        "car-quarter-" + scene.part_materials.front().name, scene, view, options);
}

double brightest_channel(const ImageF& image, int x, int y) {
    const float* p = image.pixel(x, y);
    return std::max({p[0], p[1], p[2]});
}

TEST(GlAgainstReference, NoFalseLineOnTheShouldersCrease) {
    // Two smooth sides meet along the shoulder; no direction between their normals is on the car.
    // A lamp that only such a direction mirrors made a dashed line of luminance 1 there. No pixel
    // may be brighter than the brightest of the truth beside it by more than a tenth of design
    // white, this file's limit for single pixels.
    const View view = cropped(quarter_view(), 160, 155, 112, 40);
    const Scene scene = quarter_scene(coated(0.02));
    const ImageF truth = truth_of(scene, view, 64);
    for (const Quality quality : {Quality::draft, Quality::normal}) {
        const ImageF drawn = draw(scene, view, quality);
        double worst = 0.0;
        for (int y = 1; y + 1 < view.height; ++y) {
            for (int x = 1; x + 1 < view.width; ++x) {
                double around = 0.0;
                for (int j = -1; j <= 1; ++j) {
                    for (int i = -1; i <= 1; ++i) {
                        around = std::max(around, brightest_channel(truth, x + i, y + j));
                    }
                }
                worst = worse_of(worst, brightest_channel(drawn, x, y) - around);
            }
        }
        std::printf(
            "shoulder, %s: %.3f brighter than the truth\n", to_string(quality).c_str(), worst);
        EXPECT_LT(worst, kP99) << to_string(quality);
    }
}

TEST(GlAgainstReference, JointsAreDarkInADraftToo) {
    // Between the doors, row by row: where the truth is darkest, the draft is darker than the doors
    // beside it, or as they are where the four rays of a pixel pass the joint by. It shone there
    // while it let the whole environment into the joint.
    const View view = cropped(quarter_view(), 156, 182, 22, 16);
    const Scene scene = quarter_scene(coated(0.02));
    const ImageF drawn = draw(scene, view, Quality::draft), truth = truth_of(scene, view, 64);
    double sum = 0.0;
    for (int y = 0; y < view.height; ++y) {
        constexpr int kBeside = 5;
        int joint = kBeside;
        for (int x = kBeside; x < view.width - kBeside; ++x) {
            if (brightest_channel(truth, x, y) < brightest_channel(truth, joint, y)) {
                joint = x;
            }
        }
        const double beside = 0.5 * (brightest_channel(drawn, joint - kBeside, y) +
                                     brightest_channel(drawn, joint + kBeside, y));
        const double share = brightest_channel(drawn, joint, y) / beside;
        EXPECT_LT(share, 1.01) << "row " << y;
        sum += share / view.height;
    }
    std::printf("joint in a draft: %.3f of the doors beside it\n", sum);
    EXPECT_LT(sum, 0.9);
}

TEST(GlAgainstReference, WheelsHaveNoPepper) {
    // A strip from arch to arch through the tyre, the spokes and what lies between them, where
    // little of the sky reaches. Relative, of each pixel's brightest channel; what is asked is 20%
    // at the 95th percentile. The truth has a few per cent of noise of its own.
    Material matte;
    matte.name = "matte";
    matte.diffuse = glm::dvec3(0.5);
    const View view = cropped(quarter_view(), 366, 240, 110, 18);
    const Scene scene = quarter_scene(matte);
    const ImageF truth = truth_of(scene, view, 1024);
    for (const Quality quality : {Quality::normal, Quality::high}) {
        const ImageF drawn = draw(scene, view, quality);
        std::vector<double> errors;
        for (int y = 0; y < view.height; ++y) {
            for (int x = 0; x < view.width; ++x) {
                if (truth.at(x, y, 3) < 0.999f || drawn.at(x, y, 3) < 0.999f) continue;
                const double right = brightest_channel(truth, x, y);
                errors.push_back(worst_if_nan(std::abs(brightest_channel(drawn, x, y) - right) /
                                              std::max(right, 0.005)));
            }
        }
        ASSERT_GT(errors.size(), 1500u);
        std::sort(errors.begin(), errors.end());
        const double p95 = errors[errors.size() * 95 / 100];
        std::printf("wheel, %s: relative error median %.3f, 95%% %.3f\n",
                    to_string(quality).c_str(),
                    errors[errors.size() / 2],
                    p95);
        EXPECT_LT(p95, 0.2) << to_string(quality);
    }
}

}  // namespace
}  // namespace livery
