// What a seat misses: nothing of a matte paint, more of a shiny one the farther it is from the eye.

#include "jobs/seat_errors.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "core/pictures/picture_means.h"
#include "radiance/scenes.h"

namespace livery {
namespace {

constexpr double kDegrees = std::numbers::pi / 180.0;

Material matte() {
    Material paint;
    paint.model = ReflectanceModel::lambert;
    paint.diffuse = {0.4, 0.1, 0.1};
    return paint;
}

/// A black with a lobe of this width over it.
Material shiny(double alpha) {
    Material paint;
    paint.model = ReflectanceModel::ggx;
    paint.diffuse = {0.02, 0.02, 0.02};
    paint.f0 = {0.6, 0.6, 0.6};
    paint.alpha = {alpha, alpha};
    return paint;
}

/// A sphere lit from straight ahead, symmetrical about the plane x = 0.
Scene ball(const Material& paint) {
    Scene scene = scene_of(make_sphere({0, 0, 0}, 40.0, 96, "body"), paint);
    DirectionalLight light;
    light.direction = {0.0, 0.6, 0.8};
    light.radiance_rec709 = glm::dvec3(1.0);
    light.angle_rad = 0.05;
    scene.lights = {light};
    scene.eye_in_world_mm = {0.0, 300.0, 800.0};
    return scene;
}

/// At an angle about the vertical from straight ahead, as far as the eye is.
glm::dvec3 turned(double degrees) {
    return {800.0 * std::sin(degrees * kDegrees), 300.0, 800.0 * std::cos(degrees * kDegrees)};
}

const View kProjector = look_at({0.0, 250.0, 900.0}, glm::dvec3(0.0), 0.12, 240, 160);

std::vector<SeatError> errors_of(const Scene& scene, const std::vector<EyeSeat>& seats) {
    SeatPictures pictures(scene.product, kProjector, levels_of(Quality::draft));
    return seat_errors(pictures, scene, seats);
}

std::vector<EyeSeat> sweep() {
    std::vector<EyeSeat> seats;
    int number = 0;
    for (const double degrees : {0.0, 4.0, 8.0, 16.0, 24.0, 32.0}) {
        seats.push_back({++number, turned(degrees), true});
    }
    return seats;
}

TEST(SeatErrors, AMattePaintIsTheSameFromEverySeat) {
    for (const SeatError& error : errors_of(ball(matte()), sweep())) {
        // Half floats of the picture round to 0.001 of white: far less than 0.05 of a difference.
        EXPECT_LT(error.de00_p95, 0.05);
        EXPECT_EQ(error.share_over, 0.0);
        EXPECT_TRUE(is_fair(error));
    }
}

TEST(SeatErrors, AShinyPaintIsMissedMoreTheFartherASeatIsFromTheEye) {
    // A lobe wide enough to overlap with itself over the whole sweep: without overlap nothing
    // grows.
    const auto errors = errors_of(ball(shiny(0.35)), sweep());
    ASSERT_EQ(errors.size(), 6u);
    EXPECT_EQ(errors[0], SeatError()) << "the seat whose eye it is misses nothing";
    for (std::size_t k = 1; k < errors.size(); ++k) {
        EXPECT_GT(errors[k].de00_p95, errors[k - 1].de00_p95) << k;
        EXPECT_GE(errors[k].share_over, errors[k - 1].share_over) << k;
    }
    EXPECT_GT(errors.back().de00_p95, 5.0);
    EXPECT_FALSE(is_fair(errors.back()));
}

TEST(SeatErrors, TheMeanOfTwoSymmetricalSeatsIsAsFarOffForBoth) {
    Scene scene = ball(shiny(0.3));
    const std::vector<EyeSeat> seats{{1, turned(-15.0), true}, {2, turned(15.0), true}};
    scene.eye_in_world_mm = *mean_eye_mm(seats);
    const auto errors = errors_of(scene, seats);
    ASSERT_EQ(errors.size(), 2u);
    EXPECT_GT(errors[0].de00_p95, 1.0);
    // The sphere's facets are not quite symmetrical, nor are the pixels' sub-samples: a tenth.
    EXPECT_NEAR(errors[0].de00_p95, errors[1].de00_p95, 0.1 * errors[0].de00_p95);
    EXPECT_NEAR(errors[0].share_over, errors[1].share_over, 0.02);
    EXPECT_NEAR(errors[0].de00_median, errors[1].de00_median, 0.1);
}

TEST(SeatErrors, WhatIsBrighterThanTheDesignWhiteLooksAlike) {
    Scene bright = ball(matte());
    bright.exposure_ev = 8.0;
    SeatPictures pictures(bright.product, kProjector, levels_of(Quality::draft));
    const ImageF picture = pictures.drawn_for(bright, bright.eye_in_world_mm);
    float brightest = 0.0f;
    for (std::size_t i = 0; i < picture.pixel_count(); ++i) {
        brightest = std::max(brightest, picture.values[4 * i]);
    }
    EXPECT_EQ(brightest, 1.0f);
}

TEST(SeatErrors, FiguresAreThoseOfTheCoveredPixels) {
    ImageF de00(10, 10, 1, std::nanf(""));
    for (int k = 0; k < 50; ++k) de00.values[static_cast<std::size_t>(k)] = k < 40 ? 1.0f : 3.5f;
    const SeatError error = seat_error(de00);
    EXPECT_EQ(error.de00_median, 1.0);
    EXPECT_EQ(error.de00_p95, 3.5);
    EXPECT_DOUBLE_EQ(error.share_over, 0.2);
    EXPECT_TRUE(is_fair(error));
    EXPECT_EQ(seat_error(ImageF(4, 4, 1, std::nanf(""))), SeatError());
}

TEST(SeatErrors, TheViewHasHalfThePixelsAndTheSameLens) {
    const View half = seat_error_view(kProjector);
    EXPECT_EQ(half.width, 120);
    EXPECT_EQ(half.height, 80);
    const auto there = project(kProjector, {10.0, 20.0, 30.0});
    const auto here = project(half, {10.0, 20.0, 30.0});
    ASSERT_TRUE(there && here);
    EXPECT_NEAR(here->x, 0.5 * there->x, 1e-9);
    EXPECT_NEAR(here->y, 0.5 * there->y, 1e-9);
    EXPECT_EQ(seat_error_levels(Quality::reference, {}), levels_of(Quality::high));
}

}  // namespace
}  // namespace livery
