#include "radiance/raster_preview.h"

#include <algorithm>
#include <cmath>
#include <set>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "appearance/model_table.h"
#include "core/worst_error.h"
#include "gl/context.h"
#include "radiance/renderer.h"
#include "radiance/scenes.h"
#include "radiance/shading.h"
#include "support/direct_levels.h"
#include "support/gl_device.h"

namespace livery {
namespace {

/// Differences of both paths' pictures on pixels of one part whose neighbours are wholly of that
/// part: silhouettes, part borders and shadow edges between vertices are each path's own.
std::vector<double> interior_differences(const ImageF& a, const ImageF& b, const SurfaceMap& map) {
    std::vector<double> differences;
    std::vector<int> parts(map.coverage.pixel_count(), -1), fragments(map.coverage.pixel_count());
    for (const Fragment& f : map.fragments) {
        parts[f.pixel] = f.part;
        fragments[f.pixel] += 1;
    }
    for (int y = 1; y + 1 < map.height; ++y) {
        for (int x = 1; x + 1 < map.width; ++x) {
            bool interior = true;
            const auto centre = map.coverage.index(x, y);
            for (int v = y - 1; v <= y + 1; ++v) {
                for (int u = x - 1; u <= x + 1; ++u) {
                    const auto i = map.coverage.index(u, v);
                    interior = interior && map.coverage.values[i] >= 1.0f && fragments[i] == 1 &&
                               parts[i] == parts[centre];
                }
            }
            if (!interior) continue;
            double largest = 0.0;
            for (int c = 0; c < 3; ++c) {
                largest =
                    worse_of(largest, static_cast<double>(std::abs(a.at(x, y, c) - b.at(x, y, c))));
            }
            differences.push_back(largest);
        }
    }
    std::sort(differences.begin(), differences.end());
    return differences;
}

/// Brighter to one side and below, turned about the vertical.
std::shared_ptr<const Environment> gradient() {
    Environment sky;
    sky.rotation_rad = 0.9;
    sky.scale = 0.5;
    sky.radiance_working = ImageF(64, 32, 3);
    for (int y = 0; y < 32; ++y) {
        for (int x = 0; x < 64; ++x) {
            const glm::dvec3 d = direction_from_uv(sky, {(x + 0.5) / 64, (y + 0.5) / 32});
            for (int c = 0; c < 3; ++c) {
                sky.radiance_working.at(x, y, c) = static_cast<float>(1.0 + 0.7 * d.x - 0.2 * d.y);
            }
        }
    }
    return std::make_shared<const Environment>(sky);
}

TEST(RasterPreview, AgreesWithTheSurfaceMapInside) {
    HeadlessContext context(tested_gl());
    View view = test_view(120, 90);
    view.distortion = {-0.1, 0.02, 1e-3, -5e-4, 0.0};
    for (const ModelInfo& info : formula_models()) {
        const ReflectanceModel model = info.model;
        Scene scene = scene_of(two_spheres(), paint_of(model, 0.2));
        scene.part_materials[0].film_nm = 320.0;
        scene.lights = {light_from({0.5, 0.8, 0.6}, 3.0 * kDegree_rad),
                        light_from({-0.9, 0.3, 0.5}, 0.0, 0.3)};
        if (!has_own_shading(model) || model_info(model).has("coat_alpha")) {
            scene.environment = gradient();
        }
        RadianceRenderer renderer(scene.product, view);
        FramePlan plan = plan_frame(scene, direct_levels(Quality::normal), FrameStage::radiance);
        renderer.render(scene, plan);
        RasterPreview preview(scene.product);
        preview.render(scene, view);
        const auto differences =
            interior_differences(renderer.read_back(), preview.read_back(), renderer.surface_map());
        ASSERT_GT(differences.size(), 1000u);
        // Shadows and openness are interpolated over triangles of a millimetre or two here; the
        // preview's mirror lobes are round, the renderer's are sampled.
        const double median = differences[differences.size() / 2];
        const double p95 = differences[differences.size() * 95 / 100];
        std::printf("    %-30s median %.4f p95 %.4f largest %.4f\n",
                    info.name,
                    median,
                    p95,
                    differences.back());
        EXPECT_LT(median, 0.01);
        EXPECT_LT(p95, 0.05);
    }
}

TEST(RasterPreview, ShowsTheGlintsOfTheProjectorsPixels) {
    HeadlessContext context(tested_gl());
    const View projector = test_view(120, 90);
    Scene scene = scene_of(make_sphere({0, 0, 0}, 40.0, 128, "body"),
                           paint_of(ReflectanceModel::car_paint, 0.05));
    Material& paint = scene.part_materials[0];
    paint.diffuse = paint.f0 = glm::dvec3(0.0);
    paint.coat_f0 = 0.0;
    paint.flake_f0 = glm::dvec3(0.5);
    paint.flake_alpha = 0.4;
    scene.lights = {light_from({0.1, 0.4, 1.0}, 3.0 * kDegree_rad)};
    Scene glinting = scene;
    glinting.part_materials[0].glint_density_per_mm2 = 3000.0;
    const auto drawn = [&](const Scene& some) {
        RadianceRenderer renderer(some.product, projector);
        FramePlan plan = plan_frame(some, direct_levels(Quality::normal), FrameStage::radiance);
        renderer.render(some, plan);
        return renderer.read_back();
    };
    RasterPreview preview(scene.product, 1);
    const auto previewed = [&](const Scene& some, const View& view) {
        preview.render(some, view);
        return preview.read_back();
    };
    /// What the glints add to each inner pixel, as a share of what is there without.
    const auto glints = [&](const ImageF& with, const ImageF& without) {
        std::vector<double> shares;
        for (std::size_t i = 0; i < with.pixel_count(); ++i) {
            const double smooth = static_cast<double>(without.values[4 * i]);
            const bool inside = without.values[4 * i + 3] >= 1.0f && smooth > 0.05;
            const double value = static_cast<double>(with.values[4 * i]);
            shares.push_back(inside ? value / smooth - 1.0 : 0.0);
        }
        return shares;
    };
    const auto deviation = [](const std::vector<double>& shares) {
        double squares = 0.0, count = 0.0;
        for (const double share : shares) {
            squares += share * share;
            count += share != 0.0 ? 1.0 : 0.0;
        }
        return std::sqrt(squares / count);
    };
    const std::vector<double> on_mock_up = glints(drawn(glinting), drawn(scene));
    const std::vector<double> shown =
        glints(previewed(glinting, projector), previewed(scene, projector));
    double product = 0.0, a2 = 0.0, b2 = 0.0;
    for (std::size_t i = 0; i < shown.size(); ++i) {
        product += shown[i] * on_mock_up[i];
        a2 += shown[i] * shown[i];
        b2 += on_mock_up[i] * on_mock_up[i];
    }
    std::printf("    correlation %.3f, deviation %.3f on the mock-up, %.3f in the preview\n",
                product / std::sqrt(a2 * b2),
                deviation(on_mock_up),
                deviation(shown));
    // The same glints at the same places, but for a pixel's mean point and its middle.
    EXPECT_GT(product / std::sqrt(a2 * b2), 0.8);

    // Seen from four times as near a pixel holds fewer flakes, the projector's still as many.
    View near_by = projector;
    near_by.focal_px *= 4.0;
    const double own = deviation(glints(previewed(glinting, near_by), previewed(scene, near_by)));
    preview.set_glint_view(projector);
    const double projectors =
        deviation(glints(previewed(glinting, near_by), previewed(scene, near_by)));
    EXPECT_GT(own, 2.0 * projectors);
    EXPECT_NEAR(projectors, deviation(on_mock_up), 0.4 * projectors);
}

TEST(RasterPreview, FollowsTheViewAndLeavesTheRestEmpty) {
    HeadlessContext context(tested_gl());
    Scene scene = scene_of(make_sphere({0, 0, 0}, 40.0, 64, "ball"),
                           paint_of(ReflectanceModel::lambert, 0.5));
    scene.lights = {light_from({0, 0.3, 1}, 0.0)};
    RasterPreview preview(scene.product, 1);
    for (const glm::dvec3 from : {glm::dvec3(0, 0, 500), glm::dvec3(400, 100, 300)}) {
        const View view = look_at(from, {0, 40, 0}, 0.4, 64, 48);
        preview.render(scene, view);
        const ImageF image = preview.read_back();
        const auto centre = project(view, {0, 0, 0});
        ASSERT_TRUE(centre);
        EXPECT_EQ(image.at(static_cast<int>(centre->x), static_cast<int>(centre->y), 3), 1.0f);
        EXPECT_EQ(image.at(0, 0, 3), 0.0f);
        EXPECT_EQ(image.at(0, 0, 0), 0.0f);
    }
}

TEST(RasterPreview, RefusesWhatItCannotDraw) {
    HeadlessContext context(tested_gl());
    const Scene scene = scene_of(two_spheres(), paint_of(ReflectanceModel::lambert, 0.5));
    EXPECT_THROW(RasterPreview(nullptr), std::invalid_argument);
    EXPECT_THROW(RasterPreview(scene.product, 9), std::invalid_argument);
    RasterPreview preview(scene.product);
    const Scene other = scene_of(two_spheres(), paint_of(ReflectanceModel::lambert, 0.5));
    EXPECT_THROW(preview.render(other, test_view(8, 8)), std::invalid_argument);
}

}  // namespace
}  // namespace livery
