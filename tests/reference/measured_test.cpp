// Measured paints in the path tracer: as the formula that they were made from.
#include <cmath>

#include <gtest/gtest.h>

#include "appearance/measured_like.h"
#include "reference/scenes.h"

namespace livery {
namespace {

Material glossy() {
    Material material;
    material.name = "glossy";
    material.model = ReflectanceModel::ggx;
    material.diffuse = {0.5, 0.2, 0.1};
    material.f0 = glm::dvec3(0.1);
    material.alpha = glm::dvec2(0.25);
    return material;
}

PictureMean picture_of(const Material& material, std::shared_ptr<const Environment> environment) {
    Scene scene =
        scene_of(make_sphere({0.0, 0.0, 0.0}, 50.0, 128, "part"), material, {0.0, 0.0, 4000.0});
    scene.environment = std::move(environment);
    ReferenceOptions options;
    options.samples_per_pixel = 64;
    options.bounces = 2;
    return mean_of(trace_reference(
        scene, look_at({0.0, 0.0, 4000.0}, {0.0, 0.0, 0.0}, 0.0252, 32, 32), options));
}

TEST(MeasuredPaths, ASphereHasTheFormulasColourWithAsLittleNoise) {
    const auto uniform = std::make_shared<const Environment>(*uniform_environment(1.0f));
    const PictureMean formula = picture_of(glossy(), uniform);
    const PictureMean measured = picture_of(measured_like(glossy()), uniform);
    ASSERT_GT(measured.pixels, 500);
    for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(measured.colour[c],
                    formula.colour[c],
                    4.0 * std::hypot(measured.standard_error, formula.standard_error) +
                        0.01 * formula.colour[c]);
    }
    EXPECT_LT(measured.standard_error, 3.0 * formula.standard_error + 1e-3);
}

}  // namespace
}  // namespace livery
