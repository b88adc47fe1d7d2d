#include "twin/sphere_stand.h"

#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <gtest/gtest.h>

namespace livery {
namespace {

constexpr int kSphereView_px = 96;

Material white(double reflectance) {
    Material paint;
    paint.model = ReflectanceModel::lambert;
    paint.diffuse = glm::dvec3(reflectance);
    return paint;
}

/// What the camera's green sees a second around a point of the world, of light in the working
/// space.
double light_at(const SphereStand& stand, const ImageF& light, const glm::dvec3& x_mm) {
    const auto pixel = project(stand.camera.view, x_mm);
    EXPECT_TRUE(pixel);
    const float* value = light.pixel(static_cast<int>(pixel->x), static_cast<int>(pixel->y));
    return (glm::inverse(stand.camera_from_working) * glm::dvec3(value[0], value[1], value[2])).y;
}

TEST(SphereStand, LightFallsOffWithDistanceAndCosine) {
    SphereStand stand = usual_sphere_stand({}, kSphereView_px, kSphereView_px);
    stand.lamp_diameter_mm = 0.01;
    const glm::dvec3 lamp(200.0, 100.0, 500.0);
    const ImageF light = sphere_light(stand, white(0.8), lamp);
    for (const glm::dvec3 toward :
         {glm::dvec3(0, 0, 1), glm::dvec3(0.4, 0.1, 0.9), glm::dvec3(-0.3, 0.3, 0.9)}) {
        const glm::dvec3 n = glm::normalize(toward);
        const glm::dvec3 way = lamp - 30.0 * n;
        const double distance = glm::length(way);
        const double expected =
            20'000.0 * 0.8 * glm::dot(n, way) / distance * std::pow(600.0 / distance, 2.0);
        EXPECT_NEAR(light_at(stand, light, 30.0 * n) / expected, 1.0, 0.01);
    }
    // The other side of the sphere is dark, and the cloth nearly.
    EXPECT_LT(light_at(stand, light, 30.0 * glm::normalize(glm::dvec3(-0.95, -0.2, -0.02))), 800.0);
    const double cloth = light_at(stand, light, {0.0, 40.0, 0.0});
    EXPECT_GT(cloth, 0.0);
    EXPECT_LT(cloth, 100.0);
}

TEST(SphereStand, LampsStandFromBesideTheCameraToBehindTheSphere) {
    const SphereStand stand = usual_sphere_stand({}, kSphereView_px, kSphereView_px);
    ASSERT_EQ(stand.lamps_mm.size(), 28u);
    const auto degrees = [](const glm::dvec3& lamp) {
        return std::acos(lamp.z / glm::length(lamp)) * 180.0 / std::numbers::pi;
    };
    EXPECT_NEAR(degrees(stand.lamps_mm.front()), 4.0, 1e-9);
    EXPECT_NEAR(degrees(stand.lamps_mm.back()), 158.0, 1e-9);
    for (const glm::dvec3& lamp : stand.lamps_mm) {
        EXPECT_NEAR(glm::length(lamp), 600.0, 1e-9);
        // Not in the picture, and not between the sphere and the camera.
        const auto pixel = project(stand.camera.view, lamp);
        const bool shown = pixel && pixel->x >= 0.0 && pixel->y >= 0.0 &&
                           pixel->x < kSphereView_px && pixel->y < kSphereView_px;
        EXPECT_FALSE(shown);
    }
}

TEST(SphereStand, FlareReachesTheCloth) {
    CameraDescription camera;
    const glm::dvec3 lamp(0.0, 60.0, 590.0), beside(0.0, 35.0, 0.0);
    const SphereStand clean = usual_sphere_stand(camera, kSphereView_px, kSphereView_px);
    camera.flare = 0.02;
    const SphereStand flaring = usual_sphere_stand(camera, kSphereView_px, kSphereView_px);
    EXPECT_GT(light_at(flaring, sphere_light(flaring, white(0.8), lamp), beside),
              light_at(clean, sphere_light(clean, white(0.8), lamp), beside) + 20.0);
}

TEST(SphereStand, ALampInTheSphereIsAMistake) {
    const SphereStand stand = usual_sphere_stand({}, kSphereView_px, kSphereView_px);
    EXPECT_THROW(sphere_light(stand, white(0.5), {0.0, 0.0, 31.0}), std::invalid_argument);
}

}  // namespace
}  // namespace livery
