// Geometry at which drawing breaks: what is drawn is a number, and right where a formula says what
// is right.
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <glm/geometric.hpp>

#include "core/random.h"
#include "core/worst_error.h"
#include "gl/read_back.h"
#include "radiance/lanes/processor_shading.h"
#include "radiance/packed_fragments.h"
#include "radiance/renderer_fixture.h"
#include "support/gl_device.h"
#include "support/shading_devices.h"

namespace livery {
namespace {

class HardGeometry : public Renderer {};

/// A plate of 120 mm in z = 0, seen from +z: a fan of 4000 triangles a thousand times as long as
/// wide.
Mesh plate_of_slivers() {
    constexpr int kSteps = 2000;
    Mesh mesh;
    mesh.parts.push_back({"plate", ""});
    const auto add = [&](float x, float y) {
        mesh.positions_mm.push_back({x, y, 0.0f});
        mesh.normals.push_back({0.0f, 0.0f, 1.0f});
        mesh.uvs.push_back({0.0f, 0.0f});
    };
    add(-60.0f, -60.0f);
    for (int k = 0; k <= 2 * kSteps; ++k) {
        const float along = 120.0f * static_cast<float>(k % kSteps) / kSteps;
        if (k < kSteps) {
            add(60.0f, -60.0f + along);
        } else {
            add(60.0f - (k == 2 * kSteps ? 120.0f : along), 60.0f);
        }
    }
    for (std::uint32_t k = 1; k + 1 < mesh.positions_mm.size(); ++k) {
        mesh.triangles.push_back({0u, k, k + 1u});
        mesh.triangle_part.push_back(0);
    }
    compute_tangents(mesh);
    return mesh;
}

View plate_view() { return look_at({0, 0, 500}, {0, 0, 0}, 0.2, 48, 36); }

/// The least and the largest of all channels where the product covers a pixel; NaN is the worst.
std::pair<float, float> range_of(const ImageF& image) {
    float low = std::numeric_limits<float>::infinity(), high = -low;
    for (std::size_t i = 0; i < image.pixel_count(); ++i) {
        if (!(image.values[4 * i + 3] > 0.0f)) continue;
        for (std::size_t c = 0; c < 3; ++c) {
            high = worse_of(high, image.values[4 * i + c]);
            low = std::min(low, image.values[4 * i + c]);
        }
    }
    return {low, high};
}

void expect_numbers(const ImageF& image) {
    const auto [low, high] = range_of(image);
    EXPECT_GE(low, 0.0f);
    EXPECT_LE(high, 65504.0f);
}

std::vector<Material> hard_paints() {
    std::vector<Material> paints;
    for (const ReflectanceModel model : {ReflectanceModel::lambert,
                                         ReflectanceModel::ggx,
                                         ReflectanceModel::clearcoat,
                                         ReflectanceModel::car_paint,
                                         ReflectanceModel::ward_1992,
                                         ReflectanceModel::ashikhmin_shirley}) {
        paints.push_back(paint_of(model, 0.0015));
        if (model == ReflectanceModel::car_paint) {
            paints.back().film_nm = 900.0;
            paints.push_back(paints.back());
            paints.back().glint_density_per_mm2 = 150.0;
        }
    }
    return paints;
}

TEST_P(HardGeometry, SliversAreLitAsThePlaneThatTheyMake) {
    Scene scene = scene_of(plate_of_slivers(), paint_of(ReflectanceModel::lambert, 0.5));
    const auto light = [&](double tilt) {
        scene.lights = {light_from({std::sin(tilt), 0.0, std::cos(tilt)}, 0.0)};
        return draw(scene, plate_view());
    };
    const float facing = range_of(light(0.0)).second;
    for (const double tilt : {0.0, 0.5, 1.2, 1.5}) {
        const auto [low, high] = range_of(light(tilt));
        const float expected = facing * static_cast<float>(std::cos(tilt));
        // Red is the brightest channel, two roundings to half floats; the others are less.
        EXPECT_NEAR(high, expected, 1e-3f * expected) << tilt;
        EXPECT_GT(low, 0.0f) << tilt;
    }
}

TEST_P(HardGeometry, ALightInThePlaneGivesNothing) {
    for (const Material& paint : hard_paints()) {
        Scene scene = scene_of(plate_of_slivers(), paint);
        scene.lights = {light_from({1.0, 0.0, 0.0}, 0.0)};
        const auto [low, high] = range_of(draw(scene, plate_view()));
        EXPECT_EQ(low, 0.0f);
        EXPECT_EQ(high, 0.0f);
        // Half of a disc is above the plane: of a radius of 0.025 a mean cosine of 0.005
        scene.lights = {light_from({1.0, 0.0, 0.0}, 0.05)};
        const auto [least, most] = range_of(draw(scene, plate_view()));
        EXPECT_GE(least, 0.0f);
        EXPECT_LT(most, 0.01f);
    }
}

TEST_P(HardGeometry, AnEyeOnTheSurfaceSeesNumbers) {
    for (const Material& paint : hard_paints()) {
        Scene scene = scene_of(plate_of_slivers(), paint);
        scene.environment = studio();
        scene.lights = {light_from({0.3, 0.2, 1.0}, 0.05), light_from({-1.0, 0.0, 1e-4}, 0.0)};
        for (const glm::dvec3 eye :
             {glm::dvec3(0.0), glm::dvec3(10.0, 10.0, -1e-3), glm::dvec3(5000.0, 0.0, 0.0)}) {
            scene.eye_in_world_mm = eye;
            expect_numbers(draw(scene, plate_view(), Quality::draft));
        }
    }
}

TEST_P(HardGeometry, NeedleNormalsGiveNumbers) {
    // Of a ball, anywhere: along the surface, into it, and in no two vertices alike.
    Mesh mesh = make_sphere({0, 0, 0}, 40.0, 32, "ball");
    Random random(9);
    for (glm::vec3& normal : mesh.normals) {
        const glm::dvec3 any(random.normal(), random.normal(), random.normal());
        normal = glm::vec3(glm::normalize(any));
    }
    compute_tangents(mesh);
    for (const Material& paint : hard_paints()) {
        Scene scene = scene_of(mesh, paint);
        scene.environment = studio();
        scene.lights = {light_from({0.5, 0.8, 0.6}, 0.05), light_from({0.0, 0.0, -1.0}, 0.0)};
        expect_numbers(draw(scene, test_view(48, 36), Quality::draft));
    }
}

TEST_P(HardGeometry, APictureDoesNotDependOnTheUnit) {
    for (const ReflectanceModel model : {ReflectanceModel::lambert, ReflectanceModel::clearcoat}) {
        ImageF first;
        for (const double scale : {1.0, 1e-3, 1e-2, 1e2, 1e3}) {
            SCOPED_TRACE(scale);
            Mesh mesh = make_sphere({0, 0, 0}, 40.0 * scale, 64, "ball");
            Scene scene = scene_of(mesh, paint_of(model, 0.1));
            scene.eye_in_world_mm *= scale;
            scene.lights = {light_from({0.5, 0.8, 0.6}, 0.0)};
            const View view = look_at(scale * glm::dvec3(30, 60, 500), {0, 0, 0}, 0.26, 48, 36);
            const ImageF image = draw(scene, view);
            expect_numbers(image);
            if (first.empty()) first = image;
            double worst = 0.0, sum = 0.0;
            int count = 0;
            for (std::size_t i = 0; i < image.pixel_count(); ++i) {
                if (std::min(image.values[4 * i + 3], first.values[4 * i + 3]) < 1.0f) continue;
                const auto off =
                    static_cast<double>(std::abs(image.values[4 * i] - first.values[4 * i]));
                worst = worse_of(worst, off);
                sum += off;
                ++count;
            }
            // Rays meet other triangles by rounding, and shadow rays at the terminator their own.
            EXPECT_GT(count, 300);
            EXPECT_LT(sum / count, 1e-4);
            EXPECT_LT(worst, 0.02);
        }
    }
}

LIVERY_ON_BOTH_DEVICES(HardGeometry);

TEST(HardCoverage, FragmentsOfAMillionthOfAPixelAreBlackAndNoNumberIsMade) {
    const HeadlessContext context(tested_gl());
    SurfaceMap map;
    map.width = 4;
    map.height = 1;
    map.samples_per_pixel = 16;
    map.coverage = ImageF(4, 1, 1, 1e-6f);
    map.part_begin = {0, 6};
    for (const std::uint32_t pixel : {0u, 1u, 1u, 2u, 2u, 2u}) {
        Fragment& fragment = map.fragments.emplace_back();
        fragment.coverage = 1e-6f;
        fragment.pixel = pixel;
    }
    const PackedLayout layout = layout_of(map);
    const ProcessorShading processor(map, layout);
    ImageF on_processor(4, 1, 4);
    processor.resolve(&on_processor);

    Texture2D fragments(kPackedWidth, layout.rows, TexelFormat::rgba16f);
    fragments.clear(1.0f);
    const Texture2D target(4, 1, TexelFormat::rgba16f);
    const Framebuffer framebuffer({&target});
    ResolvePass pass(map, layout);
    pass.run(fragments, framebuffer);
    const ImageF in_gl = read_floats(target);
    for (const ImageF* image : {&std::as_const(on_processor), &in_gl}) {
        for (int x = 0; x < 3; ++x) {
            for (int c = 0; c < 3; ++c) EXPECT_TRUE(std::isfinite(image->at(x, 0, c))) << x;
            EXPECT_EQ(image->at(x, 0, 3), 0.0f) << x;  // which the compensation shows black
        }
    }
}

}  // namespace
}  // namespace livery
