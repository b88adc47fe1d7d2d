// What is hidden of an environment: the light from where, or a share of all of it.
#include "radiance/light/sky_visibility.h"

#include <cmath>
#include <cstdio>

#include <gtest/gtest.h>

#include "radiance/renderer.h"
#include "renderer_fixture.h"
#include "scenes.h"

namespace livery {
namespace {

struct SkyLight {
    std::vector<glm::vec3> open, less_light, less_share;
    SkyVisibility visibility;
};

SkyLight light_of(const Environment& environment, const SkyRays& rays) {
    const Scene scene = scene_of(two_spheres(), paint_of(ReflectanceModel::lambert, 0.5));
    const FrameGeometry geometry(scene.product, test_view(64, 48));
    const Mesh& mesh = scene.product->mesh;
    const SmoothRuns runs(geometry.map);
    const FilteredEnvironment filtered =
        filter_environment(environment, {false, true, true, false}, {});
    SkyLight light;
    light.visibility = solve_sky_visibility(mesh, *geometry.tracer, geometry.map, runs, rays);
    const auto at = [&](const SkyVisibility* visibility, Hidden hidden) {
        return sky_at_fragments(
            mesh, geometry.map, environment, filtered, visibility, hidden, runs);
    };
    light.open = at(nullptr, Hidden::light);
    light.less_light = at(&light.visibility, Hidden::light);
    light.less_share = at(&light.visibility, Hidden::share);
    return light;
}

TEST(SkyVisibility, OfEvenLightBothWaysOfHidingAreTheSame) {
    Environment even;
    even.radiance_working = ImageF(64, 32, 3, 0.7f);
    for (const SkyRays& rays : {SkyRays{16, 0, false}, SkyRays{16, 128, false}, SkyRays{64}}) {
        const SkyLight light = light_of(even, rays);
        std::size_t hidden = 0;
        for (std::size_t i = 0; i < light.open.size(); ++i) {
            // The map of even light is flat to 1e-3
            EXPECT_NEAR(light.less_share[i].y, light.less_light[i].y, 2e-3f);
            hidden += light.less_share[i].y < 0.9f * light.open[i].y;
        }
        EXPECT_GT(hidden, light.open.size() / 50);
        EXPECT_EQ(light.visibility.again.empty(), rays.more == 0);
    }
}

TEST(SkyVisibility, AShareOfTheStudioIsNearItsLight) {
    // Chosen beforehand: between two spheres the sky's light varies by less than half of itself.
    const SkyLight light = light_of(*studio(), {16, 128, false});
    double difference = 0.0, sum = 0.0;
    for (std::size_t i = 0; i < light.open.size(); ++i) {
        EXPECT_GE(light.less_share[i].y, 0.0f);
        EXPECT_LE(light.less_share[i].y, light.open[i].y);
        difference += static_cast<double>(std::abs(light.less_share[i].y - light.less_light[i].y));
        sum += static_cast<double>(light.less_light[i].y);
    }
    std::printf("    a share for the light itself: %.4f of it\n", difference / sum);
    EXPECT_LT(difference, 0.05 * sum);
    EXPECT_GT(difference, 0.0);
}

}  // namespace
}  // namespace livery
