#include "live/orbit.h"

#include <cmath>
#include <limits>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace livery {
namespace {

const Bounds kCar{{-90, 0, -38}, {95, 58, 37}};
constexpr int kWidth = 1280, kHeight = 800;
constexpr double kAspect = 1.6;

/// How far the corners of the bounds reach, as a fraction of half the picture.
glm::dvec2 reach(const View& view, const Bounds& bounds) {
    glm::dvec2 farthest(0.0);
    for (unsigned k = 0; k < 8; ++k) {
        const glm::dvec3 corner((k & 1u) ? bounds.high.x : bounds.low.x,
                                (k & 2u) ? bounds.high.y : bounds.low.y,
                                (k & 4u) ? bounds.high.z : bounds.low.z);
        const auto pixel = project(view, corner);
        if (!pixel) return glm::dvec2(1e9);
        const glm::dvec2 half(0.5 * view.width, 0.5 * view.height);
        farthest = glm::max(farthest, glm::abs(*pixel - half) / half);
    }
    return farthest;
}

TEST(Orbit, FitsTheWholeProductFromEverywhere) {
    for (double azimuth = -3.0; azimuth < 3.2; azimuth += 0.7) {
        for (double elevation = -1.4; elevation < 1.5; elevation += 0.7) {
            for (const auto& [width, height] : {std::pair(1280, 800), std::pair(300, 900)}) {
                Orbit orbit;
                orbit.azimuth_rad = azimuth;
                orbit.elevation_rad = elevation;
                orbit = fitted(orbit, kCar, static_cast<double>(width) / height);
                const glm::dvec2 far = reach(view_of(orbit, width, height), kCar);
                EXPECT_LE(std::max(far.x, far.y), 1.0 / 1.06 + 1e-9);
                EXPECT_GE(std::max(far.x, far.y), 0.9) << azimuth << " " << elevation;
            }
        }
    }
}

TEST(Orbit, LooksAtItsTargetFromItsEye) {
    Orbit orbit = default_orbit(kCar, kAspect);
    orbit.target_mm = {10, 20, 5};
    const View view = view_of(orbit, kWidth, kHeight);
    const auto pixel = project(view, orbit.target_mm);
    ASSERT_TRUE(pixel);
    EXPECT_NEAR(pixel->x, 640.0, 1e-9);
    EXPECT_NEAR(pixel->y, 400.0, 1e-9);
    EXPECT_NEAR(glm::distance(centre_in_world(view), eye_of(orbit)), 0.0, 1e-9);
    EXPECT_NEAR(glm::distance(eye_of(orbit), orbit.target_mm), orbit.distance_mm, 1e-9);
}

TEST(Orbit, DraggingTurnsTheProductWithThePointer) {
    const Orbit orbit = default_orbit(kCar, kAspect);
    // A point on the near side follows the pointer to the right and down.
    const glm::dvec3 near = orbit.target_mm + 0.1 * (eye_of(orbit) - orbit.target_mm);
    const View before = view_of(orbit, kWidth, kHeight);
    const auto from = project(before, near);
    const auto right = project(view_of(turned(orbit, {20, 0}, kHeight), kWidth, kHeight), near);
    EXPECT_GT(right->x, from->x + 1.0);
    const auto down = project(view_of(turned(orbit, {0, 20}, kHeight), kWidth, kHeight), near);
    EXPECT_GT(down->y, from->y + 1.0);
}

TEST(Orbit, NeverTurnsOverAndComesRound) {
    Orbit orbit = default_orbit(kCar, kAspect);
    for (int k = 0; k < 100; ++k) orbit = turned(orbit, {37, 50}, kHeight);
    EXPECT_EQ(orbit.elevation_rad, kLargestElevation_rad);
    EXPECT_LE(std::abs(orbit.azimuth_rad), 3.1416);
    for (int k = 0; k < 100; ++k) orbit = turned(orbit, {0, -50}, kHeight);
    EXPECT_EQ(orbit.elevation_rad, -kLargestElevation_rad);
    const Orbit round = turned(orbit, {2.0 * kHeight, 0}, kHeight);
    EXPECT_NEAR(std::remainder(round.azimuth_rad - orbit.azimuth_rad, 6.283185307179586), 0, 1e-9);
}

TEST(Orbit, ZoomsBetweenItsLimitsAndUnderThePointer) {
    Orbit orbit = default_orbit(kCar, kAspect);
    EXPECT_NEAR(zoomed(orbit, 1.0, kCar).distance_mm, 0.88 * orbit.distance_mm, 1e-9);
    EXPECT_NEAR(zoomed(zoomed(orbit, 3.0, kCar), -3.0, kCar).distance_mm, orbit.distance_mm, 1e-9);
    const double size = glm::distance(kCar.low, kCar.high);
    EXPECT_NEAR(zoomed(orbit, 1e6, kCar).distance_mm, 0.05 * size, 1e-9);
    EXPECT_NEAR(zoomed(orbit, -1e6, kCar).distance_mm, 20.0 * size, 1e-6);

    // The point of the target's plane under the pointer stays there.
    const glm::dvec2 at(760, 420);
    const View before = view_of(orbit, kWidth, kHeight);
    const Ray ray = ray_through(before, at);
    const glm::dvec3 toward = glm::normalize(orbit.target_mm - eye_of(orbit));
    const glm::dvec3 point =
        ray.origin + (orbit.distance_mm / glm::dot(ray.direction, toward)) * ray.direction;
    const Orbit nearer = zoomed(orbit, 2.0, kCar, at, {kWidth, kHeight});
    const auto pixel = project(view_of(nearer, kWidth, kHeight), point);
    ASSERT_TRUE(pixel);
    EXPECT_NEAR(pixel->x, at.x, 1e-6);
    EXPECT_NEAR(pixel->y, at.y, 1e-6);
}

TEST(Orbit, PansWithThePointerInsideTheBounds) {
    const Orbit orbit = default_orbit(kCar, kAspect);
    const Orbit moved = panned(orbit, {30, -14}, kHeight, kCar);
    const auto pixel = project(view_of(moved, kWidth, kHeight), orbit.target_mm);
    ASSERT_TRUE(pixel);
    EXPECT_NEAR(pixel->x, 670.0, 1e-6);
    EXPECT_NEAR(pixel->y, 386.0, 1e-6);
    const Orbit away = panned(orbit, {1e7, 1e7}, kHeight, kCar);
    for (int c = 0; c < 3; ++c) {
        EXPECT_GE(away.target_mm[c], kCar.low[c]);
        EXPECT_LE(away.target_mm[c], kCar.high[c]);
    }
}

TEST(Orbit, TheEyesViewStandsAtTheEyeAndShowsTheWholeProduct) {
    for (const glm::dvec3 eye : {glm::dvec3(281, 425, 696), glm::dvec3(-900, 30, 10)}) {
        const View view = eye_view(eye, kCar, kWidth, kHeight);
        EXPECT_NEAR(glm::distance(centre_in_world(view), eye), 0.0, 1e-9);
        const glm::dvec2 far = reach(view, kCar);
        EXPECT_LE(std::max(far.x, far.y), 1.0 / 1.06 + 1e-9);
        EXPECT_GE(std::max(far.x, far.y), 0.9);
    }
    // Inside the product there is no such view: as wide as it gets.
    EXPECT_NO_THROW(eye_view({0, 20, 0}, kCar, kWidth, kHeight));
}

TEST(Orbit, RefusesPicturesWithoutPixels) {
    const Orbit orbit = default_orbit(kCar, kAspect);
    EXPECT_THROW(fitted(orbit, kCar, 0.0), std::invalid_argument);
    EXPECT_THROW(fitted(orbit, kCar, std::numeric_limits<double>::quiet_NaN()),
                 std::invalid_argument);
    EXPECT_THROW(turned(orbit, {1, 1}, 0), std::invalid_argument);
    EXPECT_THROW(panned(orbit, {1, 1}, -5, kCar), std::invalid_argument);
    EXPECT_THROW(view_of(orbit, 0, 10), std::invalid_argument);
}

}  // namespace
}  // namespace livery
