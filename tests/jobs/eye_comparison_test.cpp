// What the audience sees is judged where the light falls: a wrong pose must cost, and a right one
// must not, whatever each projector pixel shows by itself.
#include <cmath>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "jobs/comparison.h"
#include "session/small_session.h"
#include "support/kept_light.h"
#include "tracing/tracer.h"
#include "twin/place.h"

namespace livery {
namespace {

using testing::live_settings;
using testing::small_bench_description;
using testing::small_bench_product;

/// A colour for every place of the world, as paint on the mock-up: waves of 40 mm.
glm::dvec3 colour_at(const glm::dvec3& x_mm) {
    glm::dvec3 rec709;
    for (int c = 0; c < 3; ++c) {
        const glm::dvec3 along = glm::normalize(glm::dvec3(1.0 + c, 1.5 - c, 1.0));
        rec709[c] = 0.35 + 0.15 * std::sin(2.0 * std::numbers::pi / 40.0 * glm::dot(along, x_mm));
    }
    return working_from_rec709() * rec709;
}

/// That paint as a view sees it at its pixels' middles; coverage 0 beside the mock-up.
ImageF painted(const View& view, const Mesh& mesh, const Tracer& tracer) {
    ImageF picture(view.width, view.height, 4);
    std::vector<TraceRay> rays(picture.pixel_count());
    for (int y = 0; y < view.height; ++y)
        for (int x = 0; x < view.width; ++x) {
            const Ray ray = ray_through(view, {x + 0.5, y + 0.5});
            TraceRay& traced = rays[static_cast<std::size_t>(y * view.width + x)];
            traced.origin = glm::vec3(ray.origin);
            traced.direction = glm::vec3(ray.direction);
        }
    std::vector<Hit> hits(rays.size());
    tracer.closest(rays, hits);
    for (std::size_t i = 0; i < hits.size(); ++i) {
        if (!hits[i].valid()) continue;
        const glm::dvec3 colour = colour_at(mesh_place(mesh, hits[i]).position_mm);
        for (std::size_t c = 0; c < 3; ++c)
            picture.values[4 * i + c] = static_cast<float>(colour[static_cast<int>(c)]);
        picture.values[4 * i + 3] = 1.0f;
    }
    return picture;
}

TEST(EyeComparison, AWrongPoseCostsWhatItCostsInTheRoom) {
    const BenchDescription description = small_bench_description();
    const auto product = small_bench_product();
    const Tracer tracer(product->mesh);
    Bench bench = testing::bench_on_kept_light(description, product, EyePicture::traced);
    const ColourCalibration calibration =
        calibrate_live(bench.ports(), live_settings(description)).calibration;
    const double white_y = design_white_luminance(calibration, 20.0, bench.truth().lit);
    const CompensationTable table = bake(calibration, white_y);
    const glm::dvec3 white_xyz = white_y * d65_xyz();
    const Image8 valid = corrected_pixels(calibration);
    const Image8 predicted = corrected_pixels(calibration, true);

    const ImageF wanted_eye_xyz =
        xyz_from_wanted(painted(bench.eye().view, product->mesh, tracer), white_y);
    const ComparisonMasks eye_masks = masks_of_eye(bench, valid, predicted, wanted_eye_xyz);
    double last = 0.0, right = 0.0;
    for (const double off_px : {0.0, 0.5, 1.0, 2.0, 4.0}) {
        View believed = description.projector.view;
        believed.principal_px.x += off_px;
        const ImageF wanted = painted(believed, product->mesh, tracer);
        const Image8 drive = compensate(table, wanted);

        // By itself each pixel shows what was drawn for it, however wrong the pose.
        const ImageF wanted_xyz = xyz_from_wanted(wanted, white_y);
        const ErrorStatistics at_pixels =
            compare_xyz(wanted_xyz,
                        bench.observe_xyz(drive),
                        white_xyz,
                        {bench.truth().lit, bench.truth().edge, valid, bench.reachable(wanted_xyz)})
                .interior;
        const ErrorStatistics seen =
            compare_xyz(wanted_eye_xyz, bench.observe_from_eye(drive), white_xyz, eye_masks)
                .interior;
        std::printf("    %.1f px off: CIEDE2000 %.3f / %.3f at the pixels, %.3f / %.3f seen\n",
                    off_px,
                    at_pixels.median,
                    at_pixels.p95,
                    seen.median,
                    seen.p95);
        EXPECT_GT(seen.pixels, 5000u);
        EXPECT_LT(at_pixels.median, 0.5);
        if (off_px == 0.0) {
            right = seen.median;
            EXPECT_LT(right, 0.8) << "0.5 for the correction, and pixels as wide as a wave's 30th";
        } else {
            EXPECT_GT(seen.median, last);
        }
        last = seen.median;
    }
    // Four pixels of 0.8 mm are half a radian of the paint's waves: plain to see.
    EXPECT_GT(last, right + 3.0);
}

TEST(EyeComparison, CountsWhatIsPredictedAndWhatIsMasked) {
    const BenchDescription description = small_bench_description();
    Bench bench =
        testing::bench_on_kept_light(description, small_bench_product(), EyePicture::traced);
    ColourCalibration calibration;
    calibration.width = description.projector.view.width;
    calibration.height = description.projector.view.height;
    calibration.status = Image8(calibration.width, calibration.height, 1);
    for (int y = 0; y < calibration.height; ++y)
        for (int x = 0; x < calibration.width; ++x)
            calibration.status.at(x, y) = static_cast<std::uint8_t>(
                x < calibration.width / 2 ? PixelStatus::predicted : PixelStatus::unlit);
    const Image8 valid = corrected_pixels(calibration);
    EXPECT_EQ(valid.values, corrected_pixels(calibration, true).values);
    EXPECT_EQ(valid.at(3, 3), 255);
    EXPECT_EQ(valid.at(calibration.width - 3, 3), 0);
    const View& eye = bench.eye().view;
    const ComparisonMasks masks =
        masks_of_eye(bench, valid, valid, ImageF(eye.width, eye.height, 3));
    std::size_t with = 0, without = 0;
    for (std::size_t i = 0; i < masks.valid.values.size(); ++i) {
        if (!masks.lit.values[i]) continue;
        (masks.valid.values[i] ? with : without) += 1;
    }
    EXPECT_GT(with, 2000u);
    EXPECT_GT(without, 2000u);
    EXPECT_EQ(masks.valid.values, masks.predicted.values);
}

}  // namespace
}  // namespace livery
