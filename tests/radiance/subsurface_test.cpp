// Light that leaves translucent parts beside where it entered: against what must be kept, and
// against walks.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include <gtest/gtest.h>

#include "appearance/subsurface/translucent_paint.h"
#include "core/colour.h"
#include "core/statistics.h"
#include "gl/context.h"
#include "radiance/light/subsurface_transport.h"
#include "radiance/renderer.h"
#include "radiance/scenes.h"
#include "reference/path_tracer.h"

namespace livery {
namespace {

TranslucentMaterial medium_named(const char* name) { return read_translucent_material(name); }

/// A ball of 50 mm across, the disc that throws an edge of shadow on it, and a lamp.
Scene shadowed_ball(const Material& paint) {
    Mesh mesh = make_sphere({0, 0, 0}, 25.0, 96, "ball");
    append(mesh, make_sphere({-25.0, 130.0, 20.0}, 25.0, 48, "block"), "");
    Scene scene = scene_of(std::move(mesh), paint);
    Material black;
    black.diffuse = glm::dvec3(0.0);
    scene.part_materials[1] = black;
    scene.lights = {light_from({0.0, 1.0, 0.15}, 0.01)};
    scene.eye_in_world_mm = {60.0, 250.0, 500.0};
    return scene;
}

TEST(SubsurfaceTransport, CoversThePartAndGivesBackWhatEnters) {
    const Mesh mesh = make_sphere({0, 0, 0}, 25.0, 96, "ball");
    const Tracer tracer(mesh);
    const SubsurfaceKernel kernel = subsurface_kernel(medium_named("marble"));
    // Red light goes farthest
    EXPECT_NEAR(kernel.reach_mm, 18.0f, 1.0f);
    // The profile's own integral is the exact total, but for what lies beyond the reach
    for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(kernel.within.back()[c] / kernel.total[c], 0.99f, 0.012f) << c;
    }
    const SubsurfaceTransport transport =
        solve_transport(mesh, tracer, 0, kernel.reach_mm, {200, true});
    double area = 0.0;
    for (const float one : transport.area_mm2) area += static_cast<double>(one);
    EXPECT_NEAR(area, 4.0 * 3.14159265 * 625.0, 0.01 * area);
    const std::size_t count = transport.area_mm2.size();
    const double neighbours =
        static_cast<double>(transport.first.back()) / static_cast<double>(count);
    EXPECT_GT(neighbours, 100.0);
    EXPECT_LT(neighbours, 400.0);
    // Even light comes back as the total of a ball everywhere
    const glm::vec3 of_ball = total_at(kernel, 1.0f / 25.0f);
    for (int c = 0; c < 3; ++c) EXPECT_GT(of_ball[c], kernel.total[c] + 0.02f);
    EXPECT_EQ(total_at(kernel, 0.0f), kernel.total);
    EXPECT_LT(total_at(kernel, -0.04f).y, kernel.total.y);
    const std::vector<glm::vec3> even(count, glm::vec3(1.0f));
    for (const glm::vec3& value : leaving_at_nodes(transport, kernel, even)) {
        for (int c = 0; c < 3; ++c) ASSERT_NEAR(value[c], of_ball[c], 0.01f);
    }
    // On one side alone, about as much comes back in all
    std::vector<glm::vec3> half(count);
    glm::dvec3 entered(0.0), left(0.0);
    for (std::size_t i = 0; i < count; ++i) {
        const bool lit = transport.exchange.nodes.position_mm(i).x > 0.0f;
        half[i] = glm::vec3(lit ? 1.0f : 0.0f);
    }
    const auto leaving = leaving_at_nodes(transport, kernel, half);
    for (std::size_t i = 0; i < count; ++i) {
        const auto a = static_cast<double>(transport.area_mm2[i]);
        entered += a * glm::dvec3(half[i]);
        left += a * glm::dvec3(leaving[i]);
    }
    for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(left[c] / entered[c], static_cast<double>(of_ball[c]), 0.01) << c;
    }
}

TEST(SubsurfaceTransport, DoesNotGoThroughTheAir) {
    // Two balls a millimetre apart in one part: no light goes from one to the other
    Mesh mesh = make_sphere({-10.5, 0, 0}, 10.0, 48, "pair");
    append(mesh, make_sphere({10.5, 0, 0}, 10.0, 48, "other"), "");
    mesh.triangle_part.assign(mesh.triangles.size(), 0);
    mesh.parts.resize(1);
    const Tracer tracer(mesh);
    const auto across = [&](bool rejects_air) {
        const SubsurfaceTransport transport =
            solve_transport(mesh, tracer, 0, 6.0f, {200, rejects_air});
        const ExchangeNodes& nodes = transport.exchange.nodes;
        std::size_t pairs = 0;
        for (std::size_t i = 0; i < nodes.size(); ++i) {
            for (std::size_t k = transport.first[i]; k < transport.first[i + 1]; ++k) {
                const float side = nodes.position_mm(i).x;
                pairs += side * nodes.position_mm(transport.other[k]).x < 0.0f ? 1u : 0u;
            }
        }
        return pairs;
    };
    const std::size_t all = across(false), left = across(true);
    EXPECT_GT(all, 1000u);
    EXPECT_LT(left, all / 50);
}

struct Differences {
    double median = 0.0, p95 = 0.0;
};
/// CIEDE2000 at the design white, of the pixels that both cover by half or more.
Differences compared(const ImageF& drawn, const ImageF& truth) {
    const glm::dvec3 white = xyz_from_working() * glm::dvec3(1.0);
    std::vector<double> found;
    for (int y = 0; y < truth.height; ++y) {
        for (int x = 0; x < truth.width; ++x) {
            const float *a = drawn.pixel(x, y), *b = truth.pixel(x, y);
            if (a[3] < 0.5f || b[3] < 0.5f) continue;
            const auto lab = [&](const float* p) {
                return lab_from_xyz(xyz_from_working() * glm::dvec3(p[0], p[1], p[2]), white);
            };
            found.push_back(ciede2000(lab(a), lab(b)));
        }
    }
    return {median(found), quantile(found, 0.95)};
}

ImageF drawn_at(const Scene& scene, const View& view, int level) {
    const HeadlessContext context(GlDevice::software);
    EffectLevels levels = levels_of(Quality::high);
    levels[Effect::subsurface] = level;
    RadianceRenderer renderer(std::make_shared<const FrameGeometry>(scene.product, view),
                              false,
                              ShadingDevice::processor);
    FramePlan plan = plan_frame(scene, levels, FrameStage::radiance);
    EXPECT_EQ(find_pass(plan, PassKind::subsurface) != nullptr, level > 0);
    renderer.render(scene, plan);
    return renderer.read_back();
}

/// Samples a pixel of the walks; docs/subsurface.md has the figures of 2048.
int walks_a_pixel() {
    const char* wanted = std::getenv("LIVERY_SUBSURFACE_SAMPLES");
    return wanted ? std::max(1, std::atoi(wanted)) : 256;
}

/// Sum over columns, along the shadow's edge, of the difference of green light over that of the
/// truth: noise adds little to it.
double off_by(const ImageF& drawn, const ImageF& truth) {
    double apart = 0.0, all = 0.0;
    for (int x = 0; x < truth.width; ++x) {
        double column = 0.0;
        for (int y = 0; y < truth.height; ++y) {
            const auto t = static_cast<double>(truth.at(x, y, 1));
            column += static_cast<double>(drawn.at(x, y, 1)) - t;
            all += t;
        }
        apart += std::abs(column);
    }
    return apart / all;
}

/// A ball of 50 mm under the edge of a shadow, in pixels of 2 mm, seen from below what throws it.
TEST(SubsurfacePicture, IsNearWalksAndAlbedoAloneIsNot) {
    const View view = look_at({0, 90, 10}, {0, 24.6, 4}, 0.36, 12, 12);
    for (const char* name : {"marble", "skim milk"}) {
        const Scene scene = shadowed_ball(translucent_paint(medium_named(name), 0.1));
        ReferenceOptions options;
        options.samples_per_pixel = walks_a_pixel();
        const ImageF truth = trace_reference(scene, view, options).radiance_working;
        double off[3] = {};
        for (int level = 0; level < 3; ++level) {
            const ImageF drawn = drawn_at(scene, view, level);
            const Differences found = compared(drawn, truth);
            off[level] = off_by(drawn, truth);
            std::printf(
                "    %-10s %-10s CIEDE2000 median %.2f, 95%% %.2f; columns %.1f%% off\n",
                name,
                effect_info(Effect::subsurface).levels[static_cast<std::size_t>(level)].name,
                found.median,
                found.p95,
                100.0 * off[level]);
        }
        EXPECT_LT(off[1], 0.8 * off[0]) << name;
        EXPECT_LT(off[2], 0.8 * off[0]) << name;
        EXPECT_LT(off[2], 0.1) << name;
    }
}

}  // namespace
}  // namespace livery
