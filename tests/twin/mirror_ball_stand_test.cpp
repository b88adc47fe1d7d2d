#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "twin/sphere_stand.h"

namespace livery {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr int kBallView_px = 96;

TEST(MetalReflectance, IsFresnels) {
    // At normal incidence ((n - 1)^2 + k^2) / ((n + 1)^2 + k^2).
    const MetalIndex metal{{0.2, 2.9, 1.5}, {3.9, 3.1, 0.0}};
    const glm::dvec3 normal = metal_reflectance(metal, 1.0);
    for (int c = 0; c < 3; ++c) {
        const double n = metal.n[c], k = metal.k[c];
        EXPECT_NEAR(normal[c], ((n - 1) * (n - 1) + k * k) / ((n + 1) * (n + 1) + k * k), 1e-12);
        EXPECT_NEAR(metal_reflectance(metal, 1e-6)[c], 1.0, 1e-4);
    }
    // Glass under Brewster's angle: half of what is polarised across the plane alone.
    const double brewster = std::atan(1.5);
    const double across = std::pow(std::sin(brewster - std::asin(std::sin(brewster) / 1.5)), 2.0);
    EXPECT_NEAR(metal_reflectance(metal, std::cos(brewster)).z, 0.5 * across, 1e-12);
}

TEST(MirrorBallStand, EvenLightIsEvenInAPerfectMirror) {
    const MirrorBallStand stand = usual_mirror_ball_stand({}, kBallView_px, 1);
    const ImageF light = mirror_ball_light(
        stand, stand.cameras[0], [](const glm::dvec3&) { return glm::dvec3(0.25, 0.5, 1.0); }, 2);
    for (std::size_t k = 0; k < light.pixel_count(); ++k) {
        ASSERT_NEAR(light.values[3 * k], 5000.0f, 0.5f);
        ASSERT_NEAR(light.values[3 * k + 2], 20000.0f, 2.0f);
    }
}

TEST(MirrorBallStand, MirrorsWhatIsWhere) {
    const MirrorBallStand stand = usual_mirror_ball_stand({}, kBallView_px, 2);
    ASSERT_EQ(stand.cameras.size(), 2u);
    const View& view = stand.cameras[0].view;
    // Light from the right, from above, and from behind the camera, each with a colour of its own.
    const LightFrom light_from = [](const glm::dvec3& d) {
        const double near = std::cos(0.2);
        return glm::dvec3(d.x > near ? 1.0 : 0.0, d.y > near ? 1.0 : 0.0, d.z > near ? 1.0 : 0.0);
    };
    const ImageF light = mirror_ball_light(stand, stand.cameras[0], light_from, 4);
    const auto at = [&](const glm::dvec3& normal) {
        const auto pixel = project(view, 0.5 * stand.diameter_mm * glm::normalize(normal));
        return light.pixel(static_cast<int>(pixel->x), static_cast<int>(pixel->y));
    };
    EXPECT_NEAR(at({0.0, 0.0, 1.0})[2], 20'000.0, 1.0);
    EXPECT_NEAR(at({0.0, 0.0, 1.0})[0], 0.0, 1e-3);
    // Half way between eye and light.
    EXPECT_NEAR(at({1.0, 0.0, 1.0})[0], 20'000.0, 1.0);
    EXPECT_NEAR(at({0.0, 1.0, 1.0})[1], 20'000.0, 1.0);
    EXPECT_NEAR(at({-1.0, 0.0, 1.0})[0], 0.0, 1e-3);
    // The ball fills three quarters of the picture.
    const auto top = project(view, {0.0, 40.0, 0.0});
    EXPECT_NEAR(0.5 * kBallView_px - top->y, 0.375 * kBallView_px, 3.0);
    // The second camera is 110 degrees away.
    const glm::dvec3 a = glm::normalize(centre_in_world(view));
    const glm::dvec3 b = glm::normalize(centre_in_world(stand.cameras[1].view));
    EXPECT_NEAR(std::acos(glm::dot(a, b)), 110.0 / 180.0 * kPi, 1e-9);
}

TEST(MirrorBallStand, ItsCameraStandsInItsOwnLight) {
    MirrorBallStand stand = usual_mirror_ball_stand({}, kBallView_px, 1);
    stand.camera_radius_mm = 100.0;
    const ImageF light = mirror_ball_light(
        stand, stand.cameras[0], [](const glm::dvec3&) { return glm::dvec3(1.0); }, 2);
    const auto middle = project(stand.cameras[0].view, {0.0, 0.0, 40.0});
    EXPECT_EQ(light.at(static_cast<int>(middle->x), static_cast<int>(middle->y), 1), 0.0f);
    EXPECT_NEAR(
        light.at(kBallView_px / 2 + kBallView_px / 5, kBallView_px / 2, 1), 20'000.0f, 2.0f);
    EXPECT_NEAR(light.at(2, 2, 1), 20'000.0f, 2.0f);  // past the ball
}

}  // namespace
}  // namespace livery
