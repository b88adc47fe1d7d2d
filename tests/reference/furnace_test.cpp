// Uniform light from everywhere: what comes back is the albedo, whatever the shape.
#include <cmath>

#include <gtest/gtest.h>

#include "appearance/bsdf.h"
#include "reference/scenes.h"

namespace livery {
namespace {

constexpr double kRadius_mm = 50.0;

View far_view(int size) { return look_at({0.0, 0.0, 4000.0}, {0.0, 0.0, 0.0}, 0.0252, size, size); }

/// A sphere with many facets: directions between the shading and the true horizon carry about the
/// squared angle of a facet, 1e-3 at the rim and nothing in the middle.
Scene furnace(const Material& material, int rings) {
    Scene scene = scene_of(
        make_sphere({0.0, 0.0, 0.0}, kRadius_mm, rings, "part"), material, {0.0, 0.0, 4000.0});
    scene.environment = uniform_environment(1.0f);
    return scene;
}

TEST(Furnace, WhiteLambertSphereVanishes) {
    ReferenceOptions options;
    options.samples_per_pixel = 64;
    const ReferenceResult result =
        trace_reference(furnace(white_diffuse(1.0), 128), far_view(32), options);
    const PictureMean mean = mean_of(result);
    ASSERT_GT(mean.pixels, 500);
    for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(mean.colour[c], 1.0, 4.0 * mean.standard_error + 1e-3) << "channel " << c;
    }
    EXPECT_LT(mean.standard_error, 2e-3);
}

TEST(Furnace, WhiteLambertSphereVanishesWithBouncesToo) {
    // A sphere sees nothing of itself: bounces must add nothing.
    ReferenceOptions options;
    options.samples_per_pixel = 16;
    options.bounces = 4;
    options.sampling = ReferenceSampling::reflectance;
    const PictureMean mean =
        mean_of(trace_reference(furnace(white_diffuse(1.0), 128), far_view(32), options));
    EXPECT_NEAR(mean.colour.y, 1.0, 4.0 * mean.standard_error + 1e-3);
}

class GgxFurnace : public ::testing::TestWithParam<double> {};

TEST_P(GgxFurnace, SphereShowsTheAlbedoOfTheQuadrature) {
    Material metal;
    metal.name = "metal";
    metal.model = ReflectanceModel::ggx;
    metal.diffuse = glm::dvec3(0.0);
    metal.f0 = glm::dvec3(1.0);
    metal.alpha = glm::dvec2(GetParam());
    ReferenceOptions options;
    options.samples_per_pixel = 256;
    constexpr int kSize = 24;
    const View view = far_view(kSize);
    const ReferenceResult result = trace_reference(furnace(metal, 256), view, options);
    const f64::BsdfParameters p = parameters_of_f64(metal);
    int compared = 0;
    double chi2 = 0.0;
    for (int y = 0; y < kSize; ++y) {
        for (int x = 0; x < kSize; ++x) {
            const double dx = (x + 0.5 - kSize / 2) / view.focal_px.x * 4000.0 / kRadius_mm;
            const double dy = (y + 0.5 - kSize / 2) / view.focal_px.y * 4000.0 / kRadius_mm;
            const double mu2 = 1.0 - dx * dx - dy * dy;
            // Towards the rim the albedo is not linear over a pixel any more.
            if (mu2 < 0.3) continue;
            const double mu = std::sqrt(mu2);
            const double expected =
                directional_albedo(ReflectanceModel::ggx, p, {std::sqrt(1.0 - mu2), 0.0, mu}, 48).x;
            const double found = static_cast<double>(result.radiance_working.at(x, y, 1));
            const double se = static_cast<double>(result.standard_error.at(x, y)) + 1e-3;
            chi2 += (found - expected) * (found - expected) / (se * se);
            EXPECT_NEAR(found, expected, 5.0 * se) << "pixel " << x << ", " << y;
            ++compared;
        }
    }
    ASSERT_GT(compared, 200);
    EXPECT_LT(chi2 / compared, 1.3);
}

INSTANTIATE_TEST_SUITE_P(Alphas, GgxFurnace, ::testing::Values(0.05, 0.3, 1.0));

}  // namespace
}  // namespace livery
