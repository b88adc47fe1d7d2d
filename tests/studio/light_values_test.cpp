// Directions as angles, strengths as exposure values, and back.
#include "studio/light/light_values.h"

#include <cmath>
#include <limits>
#include <stdexcept>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace livery {
namespace {

TEST(Angles, AreThoseOfAnEnvironmentMap) {
    const auto is = [](const glm::dvec3& direction, double azimuth, double elevation) {
        const Angles angles = angles_of(direction);
        EXPECT_NEAR(angles.azimuth_deg, azimuth, 1e-9);
        EXPECT_NEAR(angles.elevation_deg, elevation, 1e-9);
    };
    is({0.0, 0.0, -1.0}, 0.0, 0.0);
    is({2.0, 0.0, 0.0}, 90.0, 0.0);
    is({0.0, 0.0, 1.0}, 180.0, 0.0);
    is({-1.0, 0.0, 0.0}, -90.0, 0.0);
    is({1.0, std::sqrt(2.0), -1.0}, 45.0, 45.0);
    // Straight up and down no azimuth is wrong; it must be one number all the same.
    is({0.0, 1.0, 0.0}, 0.0, 90.0);
    is({0.0, -3.0, 0.0}, 0.0, -90.0);
    EXPECT_THROW(angles_of(glm::dvec3(0.0)), std::invalid_argument);
}

TEST(Angles, ComeBack) {
    for (double azimuth = -175.0; azimuth <= 180.0; azimuth += 35.5) {
        for (double elevation = -89.0; elevation < 90.0; elevation += 17.8) {
            const glm::dvec3 direction = direction_of({azimuth, elevation});
            EXPECT_NEAR(glm::length(direction), 1.0, 1e-14);
            const Angles back = angles_of(direction);
            EXPECT_NEAR(back.azimuth_deg, azimuth, 1e-9);
            EXPECT_NEAR(back.elevation_deg, elevation, 1e-9);
        }
    }
}

TEST(Pad, LooksDownOnTheProduct) {
    const glm::dvec2 zenith = pad_from_angles({123.0, 90.0});
    EXPECT_NEAR(glm::length(zenith), 0.0, 1e-12);
    const glm::dvec2 right = pad_from_angles({90.0, 0.0});
    EXPECT_NEAR(right.x, 1.0, 1e-12);
    EXPECT_NEAR(right.y, 0.0, 1e-12);
    const glm::dvec2 front = pad_from_angles({180.0, 45.0});  // +z, down on the pad
    EXPECT_NEAR(front.x, 0.0, 1e-12);
    EXPECT_NEAR(front.y, 0.5, 1e-12);
    EXPECT_NEAR(glm::length(pad_from_angles({0.0, -90.0})), 2.0, 1e-12);
}

TEST(Pad, LeadsBackAndNeverBelowTheHorizon) {
    for (double azimuth = -170.0; azimuth < 180.0; azimuth += 20.0) {
        for (double elevation = 0.0; elevation < 90.0; elevation += 15.0) {
            const Angles back = angles_from_pad(pad_from_angles({azimuth, elevation}));
            EXPECT_NEAR(back.azimuth_deg, azimuth, 1e-9);
            EXPECT_NEAR(back.elevation_deg, elevation, 1e-9);
        }
    }
    const Angles outside = angles_from_pad({5.0, 0.0});
    EXPECT_EQ(outside.elevation_deg, 0.0);
    EXPECT_NEAR(outside.azimuth_deg, 90.0, 1e-12);
    const Angles middle = angles_from_pad({0.0, 0.0});
    EXPECT_EQ(middle.azimuth_deg, 0.0);
    EXPECT_EQ(middle.elevation_deg, 90.0);
}

TEST(Polar, FollowsTheEyeAroundTheProduct) {
    const glm::dvec3 centre(10.0, 20.0, 30.0), eye(281.0, 425.0, 696.0);
    const Polar polar = polar_of(eye, centre);
    EXPECT_NEAR(polar.distance_mm, glm::length(eye - centre), 1e-9);
    EXPECT_NEAR(glm::length(point_of(polar, centre) - eye), 0.0, 1e-9);
    EXPECT_EQ(polar_of(centre, centre).distance_mm, 0.0);
}

TEST(Strength, IsShownInExposureValues) {
    EXPECT_EQ(ev_of(1.0), 0.0);
    EXPECT_EQ(ev_of(0.25), -2.0);
    EXPECT_EQ(strength_of(3.0), 8.0);
    for (const double off : {0.0, -1.0, 1e-30, std::nan("")}) EXPECT_EQ(ev_of(off), kOffEv) << off;
    EXPECT_EQ(strength_of(kOffEv), 0.0);
    EXPECT_EQ(strength_of(kOffEv - 5.0), 0.0);
    EXPECT_GT(strength_of(kOffEv + 0.01), 0.0);
}

TEST(Strength, AndColourMakeTheRadiance) {
    const glm::dvec3 radiance(0.5, 0.25, -0.01);
    const StrengthColour split = split_radiance(radiance);
    EXPECT_EQ(split.strength, 0.5);
    EXPECT_EQ(split.strength * split.colour_rec709, radiance);
    const StrengthColour black = split_radiance(glm::dvec3(0.0));
    EXPECT_EQ(black.strength, 0.0);
    EXPECT_EQ(black.colour_rec709, glm::dvec3(1.0));
}

}  // namespace
}  // namespace livery
