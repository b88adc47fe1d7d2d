// Measured paints in OpenGL, on the processor and in the preview: as the formula that they were
// made from is drawn.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "appearance/measured_like.h"
#include "radiance/raster_preview.h"
#include "radiance/renderer_fixture.h"
#include "support/gl_device.h"
#include "support/radiance_error.h"
#include "support/shading_devices.h"

namespace livery {
namespace {

Material satin() { return paint_of(ReflectanceModel::ggx, 0.25); }

const Material& measured_satin() {
    static const Material material = measured_like(satin());
    return material;
}

/// Diffuse alone: as far from the other as a paint can be.
const Material& measured_chalk() {
    static const Material material = measured_like(paint_of(ReflectanceModel::lambert, 0.5));
    return material;
}

Scene lit(const Material& material) {
    Scene scene = scene_of(two_spheres(), material);
    scene.lights = {light_from({0.5, 0.8, 0.6}, 3.0 * kDegree_rad),
                    light_from({-0.9, 0.3, 0.5}, 0.0, 0.3)};
    return scene;
}

using RendererOfMeasured = Renderer;

LIVERY_ON_BOTH_DEVICES(RendererOfMeasured);

TEST_P(RendererOfMeasured, LampsShowTheFormulasPicture) {
    const View view = test_view(96, 72);
    const RadianceError error =
        radiance_error(draw(lit(measured_satin()), view), draw(lit(satin()), view));
    std::printf(
        "    lamps: median %.5f p99 %.5f bias %+.5f\n", error.median, error.p99, error.mean_signed);
    EXPECT_LT(error.median, 0.002);
    EXPECT_LT(error.p99, 0.03);
    EXPECT_LT(std::abs(error.mean_signed), 0.002);
}

TEST_P(RendererOfMeasured, AnEnvironmentShowsNearlyTheFormulasPicture) {
    const View view = test_view(48, 36);
    Scene formula = scene_of(two_spheres(), satin()),
          measured = scene_of(two_spheres(), measured_satin());
    formula.environment = measured.environment = studio();
    const RadianceError error = radiance_error(draw(measured, view), draw(formula, view));
    std::printf("    environment: median %.5f p99 %.5f bias %+.5f\n",
                error.median,
                error.p99,
                error.mean_signed);
    EXPECT_LT(error.median, 0.02);
    EXPECT_LT(error.p99, 0.06);
}

TEST_P(RendererOfMeasured, EachPartHasItsOwnGrid) {
    const View view = test_view(48, 36);
    Scene both = lit(measured_satin());
    ASSERT_EQ(both.part_materials.size(), 2u);
    both.part_materials[1] = measured_chalk();
    Scene first = both, second = both;
    first.part_materials.assign(2, measured_satin());
    second.part_materials.assign(2, measured_chalk());
    RadianceRenderer renderer = renderer_of(both, view);
    const auto picture = [&](const Scene& scene) {
        FramePlan its_plan = plan(scene);
        renderer.render(scene, its_plan);
        return renderer.read_back();
    };
    const ImageF mixed = picture(both), satin_only = picture(first), chalk_only = picture(second);
    EXPECT_EQ(picture(both).values, mixed.values) << "swapped there and back";
    std::size_t of_first = 0, of_second = 0;
    for (std::size_t k = 0; k < mixed.pixel_count(); ++k) {
        const auto same = [&](const ImageF& other) {
            return std::equal(mixed.values.begin() + static_cast<std::ptrdiff_t>(4 * k),
                              mixed.values.begin() + static_cast<std::ptrdiff_t>(4 * k + 4),
                              other.values.begin() + static_cast<std::ptrdiff_t>(4 * k));
        };
        if (mixed.values[4 * k + 3] < 1.0f || same(satin_only) == same(chalk_only)) continue;
        ++(same(satin_only) ? of_first : of_second);
    }
    EXPECT_GT(of_first, 100u);
    EXPECT_GT(of_second, 10u);
}

TEST(MeasuredPreview, ShowsTheFormulasPicture) {
    HeadlessContext context(tested_gl());
    const View view = test_view(96, 72);
    const Scene formula = lit(satin());
    Scene measured = formula;
    measured.part_materials.assign(measured.part_materials.size(), measured_satin());
    RasterPreview preview(formula.product);
    preview.render(formula, view);
    const ImageF truth = preview.read_back();
    preview.render(measured, view);
    const RadianceError error = radiance_error(preview.read_back(), truth);
    EXPECT_LT(error.median, 0.002);
    EXPECT_LT(error.p99, 0.03);
}

TEST_P(RendererOfMeasured, RefusesAPaintWithoutItsMeasurement) {
    Material nothing;
    nothing.name = "nothing";
    nothing.model = ReflectanceModel::measured;
    const View view = test_view(24, 18);
    EXPECT_THROW(draw(lit(nothing), view), std::invalid_argument);
}

}  // namespace
}  // namespace livery
