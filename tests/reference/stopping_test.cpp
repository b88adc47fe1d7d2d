// Confidence and adaptive stopping: what the tracer says of its own error is true.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "core/colour.h"
#include "core/random.h"
#include "reference/path_tracer.h"
#include "reference/scenes.h"

namespace livery {
namespace {

TEST(PixelEstimate, KnowsTheErrorOfIndependentSamples) {
    // Batches of independent numbers are independent: the mean of the squared standard errors is
    // the variance of the mean, at any number of samples.
    for (const int samples : {2, 7, 16, 17, 100, 1000}) {
        double squared_errors = 0.0, squared_standard_errors = 0.0;
        constexpr int kTrials = 4000;
        int within = 0;
        for (int trial = 0; trial < kTrials; ++trial) {
            Random random(static_cast<std::uint64_t>(trial), static_cast<std::uint64_t>(samples));
            PixelEstimate estimate;
            for (int k = 0; k < samples; ++k) {
                const glm::dvec3 value(random.uniform());
                estimate.add(&value, value.x);
            }
            const double off = estimate.colour_sum.x / samples - 0.5;
            const EstimateError error = error_of(estimate);
            squared_errors += off * off / kTrials;
            squared_standard_errors += error.standard_error * error.standard_error / kTrials;
            within += std::abs(off) <= error.half_width ? 1 : 0;
        }
        EXPECT_NEAR(squared_standard_errors / squared_errors, 1.0, 0.12) << samples << " samples";
        // Student's interval is exact for normal numbers; of two uniform ones it holds 92%.
        EXPECT_NEAR(within / static_cast<double>(kTrials), 0.95, samples < 4 ? 0.05 : 0.015)
            << samples << " samples";
    }
}

TEST(PixelEstimate, SamplesBesideTheProductCountForCoverageAlone) {
    PixelEstimate estimate;
    const glm::dvec3 value(0.25);
    for (int k = 0; k < 64; ++k) {
        if (k % 4 == 0) {
            estimate.add(&value, 0.25);
        } else {
            estimate.add(nullptr, 0.0);
        }
    }
    EXPECT_EQ(estimate.traced, 64u);
    EXPECT_EQ(estimate.covered, 16u);
    EXPECT_EQ(error_of(estimate).standard_error, 0.0);
    EXPECT_TRUE(std::isinf(error_of(PixelEstimate{}).standard_error));
}

/// A ball over a floor: smooth places, and the edge of a wide lamp's shadow.
Scene ball_over_floor() {
    Mesh mesh = make_sphere({0, 60, 0}, 30.0, 64, "part");
    add_quad(mesh, {-200, 0, 200}, {200, 0, 200}, {200, 0, -200}, {-200, 0, -200});
    Scene scene = scene_of(mesh, white_diffuse(0.5), {0, 300, 800});
    scene.lights = {light_toward({0.3, 0.9, 0.2}, 0.3)};
    return scene;
}
View over_it(int size) { return look_at({0, 300, 800}, {0, 20, 0}, 0.3, size, size); }

TEST(AdaptiveStopping, ReachesTheErrorWithFewerSamplesAndSaysHowMany) {
    const Scene scene = ball_over_floor();
    const View view = over_it(48);
    ReferenceOptions options;
    options.error = 0.05;
    options.samples_per_pixel = 1 << 16;
    const ReferenceResult result = trace_reference(scene, view, options);
    EXPECT_EQ(result.unresolved_fraction, 0.0);
    float fewest = 1e9f, most = 0.0f;
    for (std::size_t i = 0; i < result.samples.pixel_count(); ++i) {
        if (result.radiance_working.values[4 * i + 3] == 0.0f) continue;
        fewest = std::min(fewest, result.samples.values[i]);
        most = std::max(most, result.samples.values[i]);
    }
    EXPECT_EQ(static_cast<int>(most), result.samples_per_pixel);
    EXPECT_LT(fewest, 0.5f * most);
    EXPECT_GT(result.mean_samples, static_cast<double>(fewest));
    EXPECT_LT(result.mean_samples, 0.5 * static_cast<double>(most));

    // The truth lies within what it said, about as often as it said.
    options.error = 0.0;
    options.samples_per_pixel = 4096;
    options.seed = 99;
    const ReferenceResult truth = trace_reference(scene, view, options);
    const glm::dvec3 weights{
        xyz_from_working()[0].y, xyz_from_working()[1].y, xyz_from_working()[2].y};
    int within = 0, pixels = 0;
    for (std::size_t i = 0; i < truth.samples.pixel_count(); ++i) {
        const float* a = result.radiance_working.values.data() + 4 * i;
        const float* b = truth.radiance_working.values.data() + 4 * i;
        if (a[3] < 1.0f || b[3] < 1.0f) continue;
        const double off = glm::dot(weights, glm::dvec3(a[0] - b[0], a[1] - b[1], a[2] - b[2]));
        const double half = std::hypot(static_cast<double>(result.confidence.values[i]),
                                       static_cast<double>(truth.confidence.values[i]));
        within += std::abs(off) <= half ? 1 : 0;
        ++pixels;
    }
    ASSERT_GT(pixels, 800);
    // Of 95%, less what stopping at a lucky moment costs
    EXPECT_GT(within, 0.9 * pixels);
}

TEST(AdaptiveStopping, SaysWhatItDidNotReach) {
    ReferenceOptions options;
    options.error = 1e-4;
    options.samples_per_pixel = 32;
    const ReferenceResult result = trace_reference(ball_over_floor(), over_it(24), options);
    EXPECT_EQ(result.samples_per_pixel, 32);
    EXPECT_GT(result.unresolved_fraction, 0.2);
}

}  // namespace
}  // namespace livery
