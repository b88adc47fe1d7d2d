// The plan of the room: outline, extent, cones, and where a seat may be put.

#include "studio/seats/room_plan.h"

#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "scene/library.h"

namespace livery {
namespace {

/// A square of 200 mm with a point inside and one twice.
Mesh square() {
    Mesh mesh;
    for (const glm::vec3& x : {glm::vec3(-100, 0, -100),
                               glm::vec3(100, 5, -100),
                               glm::vec3(100, 9, 100),
                               glm::vec3(0, 50, 0),
                               glm::vec3(-100, 0, 100),
                               glm::vec3(-100, 70, 100)}) {
        mesh.positions_mm.push_back(x);
    }
    return mesh;
}

const std::vector<glm::dvec2> kOutline = outline_from_above(square());
const PlanExtent kExtent{{-1500.0, -1000.0}, {1500.0, 1600.0}};
const EyeSeat kSeat{1, {0.0, 480.0, 900.0}};

TEST(RoomPlan, TheOutlineIsTheHullFromAbove) {
    ASSERT_EQ(kOutline.size(), 4u);
    double area2 = 0.0;
    for (std::size_t k = 0; k < 4; ++k) {
        const glm::dvec2 a = kOutline[k], b = kOutline[(k + 1) % 4];
        area2 += a.x * b.y - a.y * b.x;
    }
    EXPECT_DOUBLE_EQ(std::abs(area2), 2.0 * 200.0 * 200.0);
    EXPECT_DOUBLE_EQ(distance_to_outline(kOutline, {300.0, 0.0}).mm, 200.0);
    EXPECT_DOUBLE_EQ(distance_to_outline(kOutline, {0.0, 60.0}).mm, -40.0);
    EXPECT_NEAR(distance_to_outline(kOutline, {130.0, 140.0}).mm, 50.0, 1e-9);
    EXPECT_EQ(distance_to_outline(kOutline, {300.0, 20.0}).nearest_mm, glm::dvec2(100.0, 20.0));
    EXPECT_TRUE(outline_from_above(Mesh()).empty());
    // Every point of the car is inside of its own.
    const auto car = find_product("car");
    const auto outline = outline_from_above(car->mesh);
    for (const glm::vec3& x : car->mesh.positions_mm) {
        ASSERT_LT(distance_to_outline(outline, in_plan(glm::dvec3(x))).mm, 1e-6);
    }
}

TEST(RoomPlan, TheExtentHoldsAllWithAMarginInTheShapeAskedFor) {
    const PlanExtent extent = plan_extent({{-400.0, 0.0}, {900.0, 700.0}}, 1.25);
    const glm::dvec2 size = extent.high_mm - extent.low_mm;
    EXPECT_NEAR(size.x / size.y, 1.25, 1e-9);
    EXPECT_LT(extent.low_mm.x, -400.0 - 0.1 * 1300.0);
    EXPECT_GT(extent.high_mm.y, 700.0 + 0.1 * 1300.0);
    // One point still is a room of a metre.
    const PlanExtent small = plan_extent({{50.0, 50.0}}, 1.0);
    EXPECT_GE(small.high_mm.x - small.low_mm.x, 1000.0);
    EXPECT_GE(plan_extent({}, 1.0).high_mm.x, 500.0);
}

TEST(RoomPlan, AConeIsWhatTheLensSees) {
    // 60 degrees wide, from +z, level
    const double focal = 500.0 / std::tan(std::numbers::pi / 6.0);
    View view = look_at({0.0, 0.0, 2000.0}, glm::dvec3(0.0), 1.0, 1000, 600);
    view.focal_px = glm::dvec2(focal);
    const auto cone = cone_in_plan(view, 1000.0);
    ASSERT_TRUE(cone);
    EXPECT_NEAR(glm::distance(cone->from_mm, {0.0, 2000.0}), 0.0, 1e-6);
    // Half a pixel in from each edge: 0.03 degrees
    EXPECT_NEAR(cone->right_mm.x, 500.0, 1.0);
    EXPECT_NEAR(cone->left_mm.x, -500.0, 1.0);
    EXPECT_NEAR(cone->right_mm.y, 2000.0 - 1000.0 * std::cos(std::numbers::pi / 6.0), 1.0);
    // Straight down, the rays through the middle of both sides still lead somewhere.
    View down = view;
    down.view_from_world.rotation = glm::dmat3(1.0);
    down.view_from_world.rotation =
        glm::dmat3(glm::dvec3(1, 0, 0), glm::dvec3(0, 0, -1), glm::dvec3(0, 1, 0));
    ASSERT_TRUE(cone_in_plan(down, 1.0));
    EXPECT_GT(cone_in_plan(down, 1.0)->right_mm.x, cone_in_plan(down, 1.0)->left_mm.x);
}

TEST(RoomPlan, TheScaleBarIsARoundLength) {
    EXPECT_DOUBLE_EQ(scale_bar_mm(730.0), 500.0);
    EXPECT_DOUBLE_EQ(scale_bar_mm(499.0), 200.0);
    EXPECT_DOUBLE_EQ(scale_bar_mm(1000.0), 1000.0);
    EXPECT_DOUBLE_EQ(scale_bar_mm(199.0), 100.0);
    EXPECT_DOUBLE_EQ(scale_bar_mm(0.0), 0.0);
    EXPECT_EQ(length_in_words(200.0), "200 mm");
    EXPECT_EQ(length_in_words(2000.0), "2 m");
}

TEST(RoomPlan, ASeatStandsWhereItIsPutOnStepsOfTenMillimetres) {
    const PlacedSeat placed = placed_seat(kSeat, {404.0, 796.0}, {kSeat}, kOutline, kExtent);
    EXPECT_EQ(placed.eye_mm, glm::dvec3(400.0, 480.0, 800.0));
    EXPECT_EQ(placed.why, "");
}

TEST(RoomPlan, ASeatNeitherLeavesThePlanNorStandsOnTheMockUpOrOnAnother) {
    const std::vector<EyeSeat> seats{kSeat, {2, {600.0, 480.0, 900.0}}};
    const auto put = [&](const glm::dvec2& at) {
        const PlacedSeat placed = placed_seat(kSeat, at, seats, kOutline, kExtent);
        std::vector<EyeSeat> after = seats;
        after[0].eye_mm = placed.eye_mm;
        EXPECT_FALSE(seats_problem(after)) << at.x << " " << at.y;
        EXPECT_GE(distance_to_outline(kOutline, in_plan(placed.eye_mm)).mm,
                  kLeastFromMockup_mm - 1.0);
        EXPECT_EQ(placed.eye_mm.y, 480.0);
        return placed;
    };
    const PlacedSeat outside = put({9000.0, -9000.0});
    EXPECT_EQ(in_plan(outside.eye_mm), glm::dvec2(1500.0, -1000.0));
    EXPECT_NE(outside.why.find("plan ends"), std::string::npos);
    for (const glm::dvec2 at : {glm::dvec2(0.0), glm::dvec2(30.0, 60.0), glm::dvec2(100.0, 0.0)}) {
        EXPECT_NE(put(at).why.find("on the mock-up"), std::string::npos);
    }
    EXPECT_NEAR(put({30.0, 60.0}).eye_mm.z, 250.0, 1e-9) << "out by the nearest way";
    const PlacedSeat beside = put({620.0, 900.0});
    EXPECT_NE(beside.why.find("Seat 2 is there"), std::string::npos);
    EXPECT_NEAR(beside.eye_mm.x, 750.5, 1e-9);
    put({600.0, 900.0});
}

TEST(RoomPlan, WhereThereIsNoRoomBesideAnotherASeatStaysWhereItWas) {
    // Seat 2 stands between the plan's corner and seat 3.
    const std::vector<EyeSeat> seats{
        kSeat, {2, {1450.0, 480.0, 1550.0}}, {3, {1250.0, 480.0, 1550.0}}};
    const PlacedSeat placed = placed_seat(kSeat, {1500.0, 1600.0}, seats, kOutline, kExtent);
    EXPECT_EQ(placed.eye_mm, kSeat.eye_mm);
    EXPECT_NE(placed.why.find("stays where it was"), std::string::npos);
}

}  // namespace
}  // namespace livery
