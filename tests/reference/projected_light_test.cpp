// The path tracer under a projector's picture: closed forms, and light that spreads from an edge.
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include <gtest/gtest.h>

#include "appearance/subsurface/subsurface_profile.h"
#include "appearance/subsurface/translucent_paint.h"
#include "reference/light_sampling.h"
#include "reference/scenes.h"

namespace livery {
namespace {

/// Over the floor, 1 m up, straight down: 200 x 100 pixels of 1 mm there.
View projector_above() {
    return look_at({0, 1000, 0.001}, {0, 0, 0}, 2.0 * std::atan(0.05), 200, 100);
}

ImageF even_picture(float value) { return ImageF(200, 100, 3, value); }

ReferenceOptions under(const View& projector, ImageF picture, double distance_mm, int samples = 4) {
    ReferenceOptions options;
    options.samples_per_pixel = samples;
    options.projected =
        std::make_shared<const ProjectedLight>(projector, std::move(picture), distance_mm);
    return options;
}

TEST(ProjectedLight, LightsAPlaneEvenlyAndByTheSquareOfItsDistance) {
    const View projector = projector_above();
    const View camera = look_at({0, 900, 5}, {0, 0, 0}, 0.08, 40, 20);
    for (const float height : {0.0f, 500.0f}) {
        Mesh mesh = floor_mesh(200.0f);
        for (glm::vec3& p : mesh.positions_mm) p.y += height;
        const Scene scene = scene_of(mesh, white_diffuse(0.8), {0, 900, 5});
        const ReferenceResult result =
            trace_reference(scene, camera, under(projector, even_picture(0.5f), 1000.0));
        const double nearer = 1000.0 / (1000.0 - static_cast<double>(height));
        for (int x = 0; x < 40; ++x) {
            const float* p = result.radiance_working.pixel(x, 10);
            if (height > 0.0f && (x < 12 || x >= 28))
                continue;  // the picture is half as wide there
            EXPECT_NEAR(p[1], 0.8 * 0.5 * nearer * nearer, 2e-3) << x << " at " << height;
        }
    }
}

TEST(ProjectedLight, FallsOnATiltedPlaneByItsCosine) {
    // A plane through the origin, turned about x: on the axis the closed form is a cosine
    for (const double tilt : {0.3, 0.8, 1.2}) {
        Mesh mesh = floor_mesh(40.0f);
        const auto turn = [&](glm::vec3 v) {
            const auto c = static_cast<float>(std::cos(tilt)),
                       s = static_cast<float>(std::sin(tilt));
            return glm::vec3(v.x, c * v.y - s * v.z, s * v.y + c * v.z);
        };
        for (glm::vec3& p : mesh.positions_mm) p = turn(p);
        for (glm::vec3& n : mesh.normals) n = turn(n);
        const Scene scene = scene_of(mesh, white_diffuse(1.0), {0, 900, 5});
        const View camera = look_at({0, 900, 5}, {0, 0, 0}, 0.002, 4, 4);
        const ReferenceResult result =
            trace_reference(scene, camera, under(projector_above(), even_picture(1.0f), 1000.0));
        EXPECT_NEAR(mean_of(result).colour.y, std::cos(tilt), 5e-3) << tilt;
    }
}

/// A lens that bends light gathers what it takes from elsewhere: all of it arrives.
TEST(ProjectedLight, SendsAllItsLightThroughADistortedLens) {
    for (const double k1 : {-0.1, 0.0, 0.1}) {
        View projector = look_at({0, 1000, 0.001}, {0, 0, 0}, 0.8, 200, 100);
        projector.distortion[0] = k1;
        const ProjectedLight light(projector, even_picture(1.0f), 1000.0);
        double all = 0.0;
        constexpr double kStep_mm = 4.0;
        for (double z = -900.0; z < 900.0; z += kStep_mm) {
            for (double x = -1800.0; x < 1800.0; x += kStep_mm) {
                const auto at = light.at({x, 0.0, z});
                all += static_cast<double>(at.irradiance.y) * static_cast<double>(at.direction.y) *
                       kStep_mm * kStep_mm;
            }
        }
        // Each pixel stands for the square of the plane that it has in a lens without distortion
        const double pixel_mm = 1000.0 / projector.focal_px.x;
        const double sent = std::numbers::pi * 200.0 * 100.0 * pixel_mm * pixel_mm;
        EXPECT_NEAR(all / sent, 1.0, 0.01) << k1;
    }
}

TEST(ProjectedLight, ShowsItsPixelsWhereTheLensPutsThem) {
    ImageF picture = even_picture(0.0f);
    for (int y = 0; y < 100; ++y) {
        for (int x = 0; x < 200; ++x) {
            if (((x / 10) + (y / 10)) % 2 == 0) picture.at(x, y, 1) = 1.0f;
        }
    }
    const View projector = projector_above();
    const Scene scene = scene_of(floor_mesh(200.0f), white_diffuse(1.0), {0, 900, 5});
    const ReferenceResult seen =
        trace_reference(scene, projector, under(projector, picture, 1000.0, 4));
    for (int y = 0; y < 100; ++y) {
        for (int x = 0; x < 200; ++x) {
            ASSERT_NEAR(seen.radiance_working.at(x, y, 1), picture.at(x, y, 1), 2e-3)
                << x << ", " << y;
            ASSERT_EQ(seen.radiance_working.at(x, y, 0), 0.0f);
        }
    }
}

TEST(ProjectedLight, IsHiddenByWhatStandsBeforeItAndNotByWhatStandsBehind) {
    for (const float height : {500.0f, 1200.0f}) {
        Mesh mesh = floor_mesh(200.0f);
        const float y = height;
        add_quad(mesh, {-20, y, 20}, {20, y, 20}, {20, y, -20}, {-20, y, -20});
        const Scene scene = scene_of(mesh, white_diffuse(1.0), {0, 400, 5});
        const View camera = look_at({0, 400, 5}, {0, 0, 0}, 0.01, 4, 4);
        const ReferenceResult result =
            trace_reference(scene, camera, under(projector_above(), even_picture(1.0f), 1000.0));
        ReferenceOptions direct = under(projector_above(), even_picture(1.0f), 1000.0);
        direct.bounces = 0;
        const double found = mean_of(trace_reference(scene, camera, direct)).colour.y;
        EXPECT_NEAR(found, height < 1000.0f ? 0.0 : 1.0, 5e-3) << height;
        EXPECT_GE(mean_of(result).colour.y, found - 1e-6);
    }
}

/// Half of the picture is lit, on marble: what comes out in the dark half is the integral of the
/// profile over the lit one.
TEST(ProjectedLight, SpreadsFromAnEdgeInATranslucentBlock) {
    Mesh mesh;
    add_box(mesh, {-60.0f, -60.0f, -60.0f}, {60.0f, 0.0f, 60.0f});
    TranslucentMaterial medium = read_translucent_material("marble");
    const Scene scene = scene_of(mesh, translucent_paint(medium), {0, 800, 0.001});
    ImageF picture = even_picture(0.0f);
    for (int y = 0; y < 100; ++y) {
        for (int x = 0; x < 100; ++x) {
            for (int c = 0; c < 3; ++c) picture.at(x, y, c) = 1.0f;
        }
    }
    // 12 x 12 pixels of a millimetre around the edge, which is at x = 0
    const View camera = look_at({0, 800, 0.001}, {0, 0, 0}, 2.0 * std::atan(6.0 / 800.0), 12, 12);
    const ReferenceResult result =
        trace_reference(scene, camera, under(projector_above(), std::move(picture), 1000.0, 512));
    const ScatteringMedium green = medium_of(medium, 1);
    const SubsurfaceProfile profile =
        subsurface_profile(SubsurfaceModel::scaled_beam_diffusion, green);
    // Light that leaves at x of light that enters at all of x' < 0
    const auto expected = [&](double x_mm) {
        double sum = 0.0;
        constexpr double kStep = 0.05;
        for (double r = std::max(x_mm, kStep); r < 60.0; r += kStep * std::max(1.0, r / 3.0)) {
            const double dr = kStep * std::max(1.0, r / 3.0), middle = r + 0.5 * dr;
            const double lit = 2.0 * std::acos(std::min(x_mm / middle, 1.0));
            sum += profile.reflectance(middle) * middle * lit * dr;
        }
        return sum;
    };
    // In through the boundary, and out toward the camera of Lambert's light under it
    const double passed = 0.96, two_c1 = 0.596346;
    const double outward = passed * passed / (1.5 * 1.5 * (1.0 - two_c1));
    for (const auto& [from, to] : {std::pair(7, 9), std::pair(9, 12)}) {
        double found = 0.0, wanted = 0.0;
        for (int x = from; x < to; ++x) {
            for (int y = 0; y < 12; ++y) {
                found += static_cast<double>(result.radiance_working.at(x, y, 1)) / 12.0;
            }
            for (const double part : {0.125, 0.375, 0.625, 0.875}) {
                wanted += 0.25 * outward * expected(x - 6 + part);
            }
        }
        std::printf(
            "    %d to %d mm beside the edge: %.4f of %.4f\n", from - 6, to - 6, found, wanted);
        // Noise of some 15,000 walks that seldom meet light, and 3% that the profile may err by
        EXPECT_NEAR(found / wanted, 1.0, 0.12) << from;
    }
}

TEST(ProjectedLight, RefusesWhatIsNoLight) {
    const View projector = projector_above();
    EXPECT_THROW(ProjectedLight(projector, ImageF(20, 10, 3), 1000.0), std::invalid_argument);
    EXPECT_THROW(ProjectedLight(projector, ImageF(200, 100, 1), 1000.0), std::invalid_argument);
    EXPECT_THROW(ProjectedLight(projector, even_picture(-1.0f), 1000.0), std::invalid_argument);
    EXPECT_THROW(
        ProjectedLight(projector, even_picture(std::numeric_limits<float>::quiet_NaN()), 1e3),
        std::invalid_argument);
    EXPECT_THROW(ProjectedLight(projector, even_picture(1.0f), 0.0), std::invalid_argument);
    // Beside it and behind it there is nothing
    const ProjectedLight light(projector, even_picture(1.0f), 1000.0);
    EXPECT_EQ(light.at({500.0, 0.0, 0.0}).irradiance, glm::vec3(0.0f));
    EXPECT_EQ(light.at({0.0, 2000.0, 0.0}).irradiance, glm::vec3(0.0f));
    EXPECT_EQ(light.at(centre_in_world(projector)).irradiance, glm::vec3(0.0f));
}

}  // namespace
}  // namespace livery
