// Open surfaces look alike whichever of their sides is called the front.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "radiance/raster_preview.h"
#include "radiance/renderer_fixture.h"
#include "reference/path_tracer.h"
#include "support/gl_device.h"
#include "support/shading_devices.h"
#include "support/small_meshes.h"

namespace livery {
namespace {

/// A box without its lid on its side, 80 mm wide, with a ball in it; triangles small enough for
/// light at vertices.
Mesh box_with_ball(bool turned) {
    constexpr int kCells = 24;
    Mesh mesh;
    const Mesh box = open_box();
    std::size_t quads = 0;
    for (std::size_t side = 0; side < 5; ++side) {
        const auto corner = [&](std::size_t k) {
            const glm::vec3 p = box.positions_mm[4 * side + k];
            return 40.0f * glm::vec3(p.x, p.z, p.y - 1.0f);
        };
        const glm::vec3 a = corner(0), right = (corner(1) - a) / static_cast<float>(kCells),
                        up = (corner(3) - a) / static_cast<float>(kCells);
        for (int j = 0; j < kCells; ++j) {
            for (int i = 0; i < kCells; ++i) {
                const glm::vec3 low =
                    a + static_cast<float>(i) * right + static_cast<float>(j) * up;
                // Exchanging y and z has mirrored the box.
                const bool outward = turned && (quads++ * 7 / 3) % 2 == 0;
                if (outward) {
                    add_quad(mesh, low, low + right, low + right + up, low + up);
                } else {
                    add_quad(mesh, low, low + up, low + right + up, low + right);
                }
            }
        }
    }
    mesh.two_sided.assign(mesh.triangles.size(), true);
    append(mesh, make_sphere({5, -22, -8}, 14.0, 24, "ball"), "");
    return mesh;
}

Scene scene_of_box(bool turned, const Material& material) {
    Scene scene = scene_of(box_with_ball(turned), material);
    auto product = std::make_shared<Product>(*scene.product);
    product->exchange = part_exchange(product->mesh);
    scene.product = product;
    scene.lights = {light_from({0.3, 0.5, 0.9}, 4.0 * kDegree_rad)};
    scene.environment = studio();
    return scene;
}

View into_box() { return look_at({60, 90, 300}, {0, 0, 0}, 0.4, 96, 72); }
View past_box() { return look_at({-250, 120, -160}, {0, 0, 0}, 0.4, 96, 72); }

/// Of covered pixels the relative difference of luminance that 95% stay below.
double difference(const ImageF& a, const ImageF& b) {
    std::vector<double> all;
    for (std::size_t i = 0; i < a.pixel_count(); ++i) {
        const float *p = a.values.data() + 4 * i, *q = b.values.data() + 4 * i;
        if (p[3] < 1.0f || q[3] < 1.0f) continue;
        all.push_back(static_cast<double>(std::abs(p[1] - q[1]) / std::max(0.02f, p[1])));
    }
    std::sort(all.begin(), all.end());
    return all.at(all.size() * 95 / 100);
}

class TwoSided : public Renderer {};

TEST_P(TwoSided, APictureDoesNotTellFrontFromBack) {
    // Rays of the other side's points are other ones: noise of a few percent where little is open.
    for (const Quality quality : {Quality::draft, Quality::normal, Quality::high}) {
        for (const View& view : {into_box(), past_box()}) {
            for (const ReflectanceModel model :
                 {ReflectanceModel::lambert, ReflectanceModel::clearcoat}) {
                const auto drawn = [&](bool turned) {
                    const Scene scene = scene_of_box(turned, paint_of(model, 0.1));
                    RadianceRenderer renderer = renderer_of(scene, view);
                    FramePlan its_plan = plan_frame(scene, quality, FrameStage::radiance);
                    renderer.render(scene, its_plan);
                    return renderer.read_back();
                };
                const double differs = difference(drawn(false), drawn(true));
                std::printf("    quality %d, model %d: %.4f\n",
                            static_cast<int>(quality),
                            static_cast<int>(model),
                            differs);
                EXPECT_LT(differs, 0.05);
            }
        }
    }
}
LIVERY_ON_BOTH_DEVICES(TwoSided);

TEST(TwoSidedPreview, DoesNotTellFrontFromBack) {
    HeadlessContext context(tested_gl());
    for (const View& view : {into_box(), past_box()}) {
        const auto drawn = [&](bool turned) {
            const Scene scene = scene_of_box(turned, paint_of(ReflectanceModel::clearcoat, 0.1));
            RasterPreview preview(scene.product);
            preview.render(scene, view);
            return preview.read_back();
        };
        const double differs = difference(drawn(false), drawn(true));
        std::printf("    preview: %.4f\n", differs);
        // 32 rays a side see a half-open sky to 9%.
        EXPECT_LT(differs, 0.1);
    }
}

TEST(TwoSidedReference, IsWhatDrawnLevelsComeNearTo) {
    HeadlessContext context(tested_gl());
    const Scene scene = scene_of_box(true, paint_of(ReflectanceModel::lambert, 0.1));
    ReferenceOptions options;
    options.samples_per_pixel = 256;
    const ImageF truth = trace_reference(scene, into_box(), options).radiance_working;
    RadianceRenderer renderer(std::make_shared<const FrameGeometry>(scene.product, into_box()),
                              false,
                              ShadingDevice::processor);
    FramePlan its_plan = plan_frame(scene, Quality::high, FrameStage::radiance);
    renderer.render(scene, its_plan);
    const double differs = difference(truth, renderer.read_back());
    std::printf("    high beside the tracer: %.4f\n", differs);
    // As `high` on the inside of a closed groove, where bounces are a third of the light.
    EXPECT_LT(differs, 0.15);
}

TEST(TwoSidedReference, MirrorsWithinOneAnotherComeNearToo) {
    HeadlessContext context(tested_gl());
    Material gold = paint_of(ReflectanceModel::ggx, 0.3);
    gold.diffuse = glm::dvec3(0.0);
    gold.f0 = {0.9, 0.6, 0.3};
    const Scene scene = scene_of_box(true, gold);
    ReferenceOptions options;
    options.samples_per_pixel = 1024;
    options.bounces = 8;
    const ImageF truth = trace_reference(scene, into_box(), options).radiance_working;
    RadianceRenderer renderer(std::make_shared<const FrameGeometry>(scene.product, into_box()),
                              false,
                              ShadingDevice::processor);
    FramePlan its_plan = plan_frame(scene, Quality::normal, FrameStage::radiance);
    renderer.render(scene, its_plan);
    const ImageF drawn = renderer.read_back();
    const double differs = difference(truth, drawn);
    // By how much a pixel differs from both of those beside it: columns share out rays
    std::vector<float> stripes;
    for (int y = 0; y < drawn.height; ++y) {
        for (int x = 1; x + 1 < drawn.width; ++x) {
            const float* v = &drawn.values[4 * static_cast<std::size_t>(y * drawn.width + x)];
            if (v[-1] < 1.0f || v[3] < 1.0f || v[7] < 1.0f) continue;
            stripes.push_back(std::abs(2.0f * v[1] / (v[-3] + v[5]) - 1.0f));
        }
    }
    std::sort(stripes.begin(), stripes.end());
    const double striped = stripes[3 * stripes.size() / 4];
    std::printf("    normal beside the tracer: %.4f, pixel beside pixel: %.4f\n", differs, striped);
    EXPECT_LT(differs, 0.2);
    EXPECT_LT(striped, 0.05);
}

}  // namespace
}  // namespace livery
