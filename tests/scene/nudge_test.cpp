#include <stdexcept>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "scene/mockup_pose.h"

namespace livery {
namespace {

const Bounds kMockup{{-90, 0, -40}, {90, 60, 40}};
const glm::dvec3 kMiddle(0, 30, 0);

View projector() { return look_at({300, 400, 900}, {20, 10, 0}, 0.4, 1280, 800); }

glm::dvec2 pixel_of(const View& view, const glm::dvec3& x) { return project(view, x).value(); }

/// A point of the mock-up that faces the projector, and one at its rim, in the first view's frame.
struct Points {
    glm::dvec3 facing, right, below;
};
Points points_of(const View& view) {
    const Rigid3 world_from_view = inverse(view.view_from_world);
    const double radius = 0.5 * glm::distance(kMockup.low, kMockup.high);
    const auto beside = [&](const glm::dvec3& offset) {
        return world_from_view * (view.view_from_world * kMiddle + offset);
    };
    return {beside({0, 0, -radius}), beside({radius, 0, 0}), beside({0, radius, 0})};
}

TEST(Nudge, MovesTheMiddleByPixels) {
    const View before = projector();
    const glm::dvec2 from = pixel_of(before, kMiddle);
    for (const double px : {0.25, 1.0, 10.0}) {
        const glm::dvec2 right = pixel_of(nudged(before, kMockup, {.right_px = px}), kMiddle);
        EXPECT_NEAR(right.x - from.x, px, 1e-9);
        EXPECT_NEAR(right.y - from.y, 0.0, 1e-9);
        const glm::dvec2 down = pixel_of(nudged(before, kMockup, {.down_px = px}), kMiddle);
        EXPECT_NEAR(down.x - from.x, 0.0, 1e-9);
        EXPECT_NEAR(down.y - from.y, px, 1e-9);
    }
}

TEST(Nudge, NearerGrowsTheRimAndKeepsTheMiddle) {
    const View before = projector(), after = nudged(before, kMockup, {.nearer_px = 2.0});
    EXPECT_NEAR(glm::distance(pixel_of(after, kMiddle), pixel_of(before, kMiddle)), 0.0, 1e-9);
    const Points p = points_of(before);
    // Perspective: a rim as near as the middle grows by what was asked for, to first order.
    EXPECT_NEAR(pixel_of(after, p.right).x - pixel_of(before, p.right).x, 2.0, 0.05);
    EXPECT_NEAR(pixel_of(after, p.below).y - pixel_of(before, p.below).y, 2.0, 0.05);
}

TEST(Nudge, TurnsTheWayItSays) {
    const View before = projector();
    const Points p = points_of(before);
    const auto moved = [&](const Nudge& by, const glm::dvec3& x) {
        return pixel_of(nudged(before, kMockup, by), x) - pixel_of(before, x);
    };
    // The side that faces the projector is nearer than the middle: its pixels are larger.
    const double nearer =
        glm::length(before.view_from_world * kMiddle) / (before.view_from_world * p.facing).z;
    EXPECT_NEAR(moved({.yaw_px = 1.0}, p.facing).x, nearer, 0.05);
    EXPECT_NEAR(moved({.pitch_px = 1.0}, p.facing).y, nearer, 0.05);
    EXPECT_NEAR(moved({.roll_px = 1.0}, p.right).y, 1.0, 0.02);
    EXPECT_NEAR(moved({.roll_px = 1.0}, p.below).x, -1.0, 0.02);
    for (const Nudge& by : {Nudge{.yaw_px = 5.0}, Nudge{.pitch_px = 5.0}, Nudge{.roll_px = 5.0}})
        EXPECT_NEAR(glm::length(moved(by, kMiddle)), 0.0, 1e-9);
}

TEST(Nudge, GoesBackTheWayItCame) {
    const View before = projector();
    View view = before;
    for (int k = 0; k < 300; ++k) view = nudged(view, kMockup, {.right_px = 1.0, .yaw_px = 0.5});
    for (int k = 0; k < 300; ++k) view = nudged(view, kMockup, {.right_px = -1.0, .yaw_px = -0.5});
    const MockupMotion rest = motion_between(before, view, kMockup);
    EXPECT_NEAR(glm::length(rest.moved_mm), 0.0, 1e-9);
    EXPECT_NEAR(rest.turned_deg, 0.0, 1e-9);
    EXPECT_EQ(in_words(rest), "not moved");
    const glm::dmat3& r = view.view_from_world.rotation;
    EXPECT_NEAR(glm::length(r[0]), 1.0, 1e-12);
    EXPECT_NEAR(glm::dot(r[0], r[1]), 0.0, 1e-12);
}

TEST(Nudge, IsSaidInWords) {
    const View before = projector();
    const std::string text = in_words(motion_between(
        before, nudged(before, kMockup, {.right_px = -3.0, .nearer_px = 1.0}), kMockup));
    EXPECT_NE(text.find("3.00 px to the left"), std::string::npos) << text;
    EXPECT_NE(text.find("mm nearer"), std::string::npos) << text;
    EXPECT_EQ(text.find("turned"), std::string::npos) << text;
    const MockupMotion turned =
        motion_between(before, nudged(before, kMockup, {.roll_px = 4.0}), kMockup);
    EXPECT_NE(in_words(turned).find("turned by"), std::string::npos);
}

TEST(Nudge, IsRefusedWhereTheProjectorDoesNotSeeTheMockup) {
    const View away = look_at({0, 30, 900}, {0, 30, 1800}, 0.4, 1280, 800);
    EXPECT_THROW(nudged(away, kMockup, {.right_px = 1.0}), std::invalid_argument);
}

}  // namespace
}  // namespace livery
