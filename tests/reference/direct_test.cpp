// Direct and bounced light against closed forms.
#include <atomic>
#include <cmath>

#include <gtest/gtest.h>

#include "core/colour.h"
#include "core/error.h"
#include "core/parallel.h"
#include "reference/light_sampling.h"
#include "reference/scenes.h"

namespace livery {
namespace {

View above_floor(int size) {
    return look_at({1.0, 1000.0, 1.0}, {0.0, 0.0, 0.0}, 0.02, size, size);
}

Material varnished() {
    Material material;
    material.name = "varnished";
    material.model = ReflectanceModel::clearcoat;
    material.diffuse = {0.5, 0.2, 0.1};
    material.f0 = {0.3, 0.2, 0.1};
    material.alpha = {0.25, 0.25};
    material.coat_alpha = 0.05;
    return material;
}

class DiscOfLight : public ::testing::TestWithParam<ReferenceSampling> {};

TEST_P(DiscOfLight, LightsAFloorWithTheCosineOfItsCentreWhateverItsSize) {
    for (const double angle_rad : {0.009, 0.05, 0.6, 1.2}) {
        Scene scene = scene_of(floor_mesh(500.0f), white_diffuse(0.8), {0.0, 1000.0, 0.0});
        // 50 degrees from the normal: the largest disc stays above the horizon.
        const double tilt = 0.872664626;
        scene.lights = {light_toward({std::sin(tilt), std::cos(tilt), 0.0}, angle_rad)};
        ReferenceOptions options;
        // A small disc is rarely met by chance.
        const bool by_chance = GetParam() == ReferenceSampling::reflectance;
        if (by_chance && angle_rad < 0.5) continue;
        options.samples_per_pixel = by_chance ? 1024 : 64;
        options.sampling = GetParam();
        const PictureMean mean = mean_of(trace_reference(scene, above_floor(8), options));
        EXPECT_NEAR(mean.colour.y, 0.8 * std::cos(tilt), 4.0 * mean.standard_error + 1e-5)
            << "angle " << angle_rad;
        EXPECT_LT(mean.standard_error, by_chance ? 0.01 : 0.006);
    }
}

INSTANTIATE_TEST_SUITE_P(Ways,
                         DiscOfLight,
                         ::testing::Values(ReferenceSampling::combined,
                                           ReferenceSampling::lights,
                                           ReferenceSampling::reflectance));

TEST(Lights, PointAtInfinityIsExactAndExposureDoubles) {
    Scene scene = scene_of(floor_mesh(500.0f), white_diffuse(0.5), {0.0, 1000.0, 0.0});
    scene.lights = {light_toward({1.0, 1.0, 0.0}, 0.0)};
    scene.lights[0].radiance_rec709 = {0.9, 0.5, 0.2};
    scene.exposure_ev = 1.0;
    ReferenceOptions options;
    options.samples_per_pixel = 4;
    const ReferenceResult result = trace_reference(scene, above_floor(4), options);
    const glm::dvec3 expected =
        2.0 * 0.5 * std::sqrt(0.5) * (working_from_rec709() * scene.lights[0].radiance_rec709);
    for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(static_cast<double>(result.radiance_working.at(1, 2, c)), expected[c], 1e-6);
    }
    EXPECT_EQ(result.radiance_working.at(1, 2, 3), 1.0f);
}

TEST(Lights, OneBrightPixelOfAnEnvironmentComesFromWhereItsDirectionSays) {
    auto environment = std::make_shared<Environment>();
    environment->radiance_working = ImageF(64, 32, 3);
    environment->rotation_rad = 0.7;
    environment->scale = 3.0;
    for (int c = 0; c < 3; ++c) environment->radiance_working.at(10, 5, c) = 100.0f;
    const double pi = 3.14159265358979;
    const double top = std::cos(pi * 5 / 32), bottom = std::cos(pi * 6 / 32);
    // Integral of the cosine to +y over the pixel: over cos from bottom to top, 2 pi / 64 wide
    const double cosine_solid_angle = 2.0 * pi / 64 * 0.5 * (top * top - bottom * bottom);
    for (const auto sampling : {ReferenceSampling::combined, ReferenceSampling::lights}) {
        Scene scene = scene_of(floor_mesh(500.0f), white_diffuse(0.6), {0.0, 1000.0, 0.0});
        scene.environment = environment;
        ReferenceOptions options;
        options.samples_per_pixel = 256;
        options.sampling = sampling;
        const PictureMean mean = mean_of(trace_reference(scene, above_floor(4), options));
        EXPECT_NEAR(
            mean.colour.y, 0.6 / pi * 300.0 * cosine_solid_angle, 4.0 * mean.standard_error + 1e-5);
        EXPECT_LT(mean.standard_error / mean.colour.y, 0.01);
    }
    const EnvironmentSampler sampler(environment.get());
    const glm::dvec3 middle = direction_from_uv(*environment, {10.5 / 64, 5.5 / 32});
    const LightSample sample = sampler.sample({0.5f, 0.5f});
    // Half a pixel is 3 degrees.
    EXPECT_GT(glm::dot(glm::dvec3(sample.direction), middle), std::cos(0.01));
    EXPECT_FLOAT_EQ(sampler.along(sample.direction).pdf, sample.pdf);
}

/// Two unit squares' sides at 90 degrees, 2000 sides long, lit from above.
Scene groove() {
    const float side = 10.0f, half = side * std::sqrt(0.5f), length = 1000.0f * side;
    Mesh mesh;
    add_quad(mesh, {0, 0, -length}, {0, 0, length}, {half, half, length}, {half, half, -length});
    add_quad(mesh, {-half, half, -length}, {-half, half, length}, {0, 0, length}, {0, 0, -length});
    Scene scene = scene_of(mesh, white_diffuse(0.5), {0.0, 1000.0, 0.0});
    scene.lights = {light_toward({0.0, 1.0, 0.0}, 0.0)};
    return scene;
}

TEST(Bounces, DiffuseGrooveAgreesWithItsRadiosity) {
    // Radiosity of an endless 90 degree groove of albedo 0.5, by an independent solution of the
    // integral equation: direct .35355, and after 8 scatterings these at these parts of the side.
    struct Known {
        double place, value;
    };
    const Scene scene = groove();
    ReferenceOptions options;
    options.samples_per_pixel = 2048;
    for (const Known known :
         {Known{0.016, 0.46697}, Known{0.525, 0.40893}, Known{0.907, 0.38702}}) {
        // A view so narrow that all of it sees one place
        const double at = known.place * 10.0 * std::sqrt(0.5);
        const View view = look_at({at - 500.0, at + 500.0, 0.0}, {at, at, 0.0}, 2e-5, 8, 8);
        options.bounces = 0;
        EXPECT_NEAR(mean_of(trace_reference(scene, view, options)).colour.y, 0.353553, 1e-5);
        options.bounces = 7;
        const PictureMean mean = mean_of(trace_reference(scene, view, options));
        EXPECT_NEAR(mean.colour.y, known.value, 4.0 * mean.standard_error + 2e-5)
            << "at " << known.place;
        EXPECT_LT(mean.standard_error, 5e-4);
    }
}

TEST(Sampling, LightsReflectanceAndBothHaveTheSameMean) {
    Scene scene = scene_of(make_sphere({0, 0, 0}, 50.0, 64, "part"), varnished(), {200, 100, 900});
    scene.lights = {light_toward({0.4, 0.8, 0.5}, 0.5)};
    auto environment = std::make_shared<Environment>();
    environment->radiance_working = ImageF(32, 16, 3);
    for (int y = 0; y < 16; ++y) {
        for (int x = 0; x < 32; ++x) {
            for (int c = 0; c < 3; ++c) {
                environment->radiance_working.at(x, y, c) =
                    0.2f + (y < 6 && (x / 4) % 2 == c % 2 ? 1.0f : 0.0f);
            }
        }
    }
    scene.environment = environment;
    // Without the rim, where finding a narrow lobe by its lights has next to endless variance
    const View view = look_at({0, 0, 1000}, {0, 0, 0}, 0.06, 24, 24);
    ReferenceOptions options;
    std::vector<PictureMean> means;
    for (const auto sampling :
         {ReferenceSampling::combined, ReferenceSampling::lights, ReferenceSampling::reflectance}) {
        options.sampling = sampling;
        options.samples_per_pixel = sampling == ReferenceSampling::combined ? 128 : 1024;
        options.seed = 7 + means.size();
        means.push_back(mean_of(trace_reference(scene, view, options)));
    }
    for (std::size_t i : {1u, 2u}) {
        const double sigma = std::hypot(means[0].standard_error, means[i].standard_error);
        EXPECT_NEAR(means[i].colour.y, means[0].colour.y, 3.0 * sigma) << "way " << i;
        EXPECT_LT(sigma, 0.02 * means[0].colour.y);
    }
}

TEST(Sampling, TheStandardErrorIsWhatTwoSeedsDifferBy) {
    Scene scene = scene_of(make_sphere({0, 0, 0}, 50.0, 64, "part"), varnished(), {200, 100, 900});
    scene.lights = {light_toward({0.4, 0.8, 0.5}, 0.1)};
    scene.environment = uniform_environment(0.3f);
    const View view = look_at({0, 0, 1000}, {0, 0, 0}, 0.1, 32, 32);
    ReferenceOptions options;
    options.samples_per_pixel = 256;
    const ReferenceResult a = trace_reference(scene, view, options);
    options.seed = 2;
    const ReferenceResult b = trace_reference(scene, view, options);
    const glm::dvec3 weights{
        xyz_from_working()[0].y, xyz_from_working()[1].y, xyz_from_working()[2].y};
    double chi2 = 0.0;
    int pixels = 0;
    for (int y = 0; y < 32; ++y) {
        for (int x = 0; x < 32; ++x) {
            // Stratified places make edges less noisy than the standard error says.
            if (a.radiance_working.at(x, y, 3) < 1.0f || b.radiance_working.at(x, y, 3) < 1.0f) {
                continue;
            }
            double difference = 0.0;
            for (int c = 0; c < 3; ++c) {
                difference += weights[c] * static_cast<double>(a.radiance_working.at(x, y, c) -
                                                               b.radiance_working.at(x, y, c));
            }
            const double sigma = std::hypot(static_cast<double>(a.standard_error.at(x, y)),
                                            static_cast<double>(b.standard_error.at(x, y)));
            chi2 += difference * difference / (sigma * sigma);
            ++pixels;
        }
    }
    ASSERT_GT(pixels, 300);
    // The mean of about 500 squares of standard normals: 1 +- 0.063, and lower: batches know less
    // of one another than they are evenly spread together (reference/path_tracer.h).
    EXPECT_LT(chi2 / pixels, 1.25);
    EXPECT_GT(chi2 / pixels, 0.1);
}

TEST(Eye, TheHighlightLiesWhereTheEyeSeesIt) {
    Material mirror = varnished();
    mirror.diffuse = mirror.f0 = glm::dvec3(0.0);
    // So narrow that the lobe's own lopsidedness stays under a tenth of a pixel
    mirror.coat_alpha = 0.005;
    const glm::dvec3 eye(-700.0, 300.0, 500.0);
    Scene scene = scene_of(make_sphere({0, 0, 0}, 50.0, 192, "part"), mirror, eye);
    scene.lights = {light_toward({0.5, 0.6, 0.6}, 0.01)};
    const View view = look_at({0, 0, 1000}, {0, 0, 0}, 0.11, 128, 128);
    ReferenceOptions options;
    options.samples_per_pixel = 16;
    for (const bool for_eye : {true, false}) {
        options.shade_for_eye = for_eye;
        const ReferenceResult result = trace_reference(scene, view, options);
        // Centroid of the light
        glm::dvec2 centroid(0.0);
        double total = 0.0;
        for (int y = 0; y < 128; ++y) {
            for (int x = 0; x < 128; ++x) {
                const double value = static_cast<double>(result.radiance_working.at(x, y, 1));
                centroid += value * glm::dvec2(x + 0.5, y + 0.5);
                total += value;
            }
        }
        centroid /= total;
        // The normal that halves light and eye, from a point on the sphere
        const glm::dvec3 from = for_eye ? eye : centre_in_world(view);
        glm::dvec3 n(0.0, 0.0, 1.0);
        for (int k = 0; k < 100; ++k) {
            n = glm::normalize(glm::normalize(from - 50.0 * n) + scene.lights[0].direction);
        }
        const auto expected = project(view, 50.0 * n);
        ASSERT_TRUE(expected);
        EXPECT_NEAR(centroid.x, expected->x, 0.3) << "for the eye: " << for_eye;
        EXPECT_NEAR(centroid.y, expected->y, 0.3) << "for the eye: " << for_eye;
    }
}

TEST(Eye, BelowTheHorizonStaysFinite) {
    Scene scene = scene_of(floor_mesh(500.0f), varnished(), {0.0, -1000.0, 300.0});
    scene.lights = {light_toward({0.3, 1.0, 0.2}, 0.05)};
    scene.environment = uniform_environment(1.0f);
    ReferenceOptions options;
    options.samples_per_pixel = 256;
    const ReferenceResult result = trace_reference(scene, above_floor(8), options);
    for (const float value : result.radiance_working.values) {
        EXPECT_TRUE(std::isfinite(value) && value >= 0.0f);
    }
}

TEST(Picture, EmptyPixelsAreZeroAndHalfCoveredOnesKeepTheirColour) {
    // The floor's edge runs through the middle of the picture.
    Scene scene = scene_of(floor_mesh(500.0f), white_diffuse(0.5), {0.0, 1000.0, 0.0});
    scene.lights = {light_toward({0.0, 1.0, 0.0}, 0.0)};
    const View view = look_at({500.0, 1000.0, 0.1}, {500.0, 0.0, 0.0}, 0.05, 15, 15);
    ReferenceOptions options;
    options.samples_per_pixel = 256;
    const ReferenceResult result = trace_reference(scene, view, options);
    double half = 0.0;
    for (int x = 0; x < 15; ++x) {
        const float* p = result.radiance_working.pixel(x, 7);
        if (p[3] == 0.0f) {
            EXPECT_EQ(p[0], 0.0f);
        } else {
            EXPECT_NEAR(static_cast<double>(p[0]), 0.5, 1e-6);
        }
        half += static_cast<double>(p[3]);
    }
    // Half of 15 pixels; the stratified edge pixel is known to 1/16.
    EXPECT_NEAR(half, 7.5, 0.1);
}

TEST(Picture, IsTheSameOnOneThreadAndOnAll) {
    Scene scene = scene_of(make_sphere({0, 0, 0}, 50.0, 24, "part"), varnished(), {200, 100, 900});
    scene.lights = {light_toward({0.4, 0.8, 0.5}, 0.5)};
    scene.environment = uniform_environment(0.3f);
    const View view = look_at({0, 0, 1000}, {0, 0, 0}, 0.1, 24, 24);
    ReferenceOptions options;
    options.samples_per_pixel = 4;
    options.bounces = 2;
    const ReferenceResult all = trace_reference(scene, view, options);
    set_thread_count(1);
    const ReferenceResult one = trace_reference(scene, view, options);
    set_thread_count(0);
    EXPECT_EQ(all.radiance_working.values, one.radiance_working.values);
}

TEST(Picture, StopsOnTimeAndOnRequest) {
    Scene scene = scene_of(make_sphere({0, 0, 0}, 50.0, 24, "part"), varnished(), {200, 100, 900});
    scene.environment = uniform_environment(0.3f);
    const View view = look_at({0, 0, 1000}, {0, 0, 0}, 0.1, 32, 32);
    ReferenceOptions options;
    options.samples_per_pixel = 1'000'000;
    options.seconds = 0.05;
    const ReferenceResult result = trace_reference(scene, view, options);
    EXPECT_GE(result.samples_per_pixel, 1);
    EXPECT_LT(result.samples_per_pixel, 1'000'000);

    std::atomic<bool> stop{false};
    Progress progress;
    progress.stop = &stop;
    progress.report = [&](double, std::string_view) { stop = true; };
    options.seconds = 0.0;
    EXPECT_THROW(trace_reference(scene, view, options, progress), Cancelled);
}

TEST(Picture, RefusesWhatCannotBe) {
    Scene scene = scene_of(floor_mesh(10.0f), white_diffuse(0.5), {0, 100, 0});
    const View view = above_floor(4);
    ReferenceOptions options;
    options.samples_per_pixel = 0;
    EXPECT_THROW(trace_reference(scene, view, options), std::invalid_argument);
    options.samples_per_pixel = 1;
    options.bounces = -1;
    EXPECT_THROW(trace_reference(scene, view, options), std::invalid_argument);
    options.bounces = 0;
    options.error = -1.0;
    EXPECT_THROW(trace_reference(scene, view, options), std::invalid_argument);
    options.error = 0.0;
    EXPECT_THROW(trace_reference(scene, View{}, options), std::invalid_argument);
    EXPECT_THROW(trace_reference(Scene{}, view, options), std::invalid_argument);
    scene.part_materials.clear();
    EXPECT_THROW(trace_reference(scene, view, options), std::invalid_argument);
}

}  // namespace
}  // namespace livery
