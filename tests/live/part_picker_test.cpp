#include <cmath>
#include <limits>
#include <set>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "live/orbit.h"
#include "live/preview_thread.h"
#include "scene/library.h"

namespace livery {
namespace {

TEST(PartPicker, FindsEveryPartOfTheCarAndNothingBeside) {
    const auto car = find_product("car");
    const PartPicker picker(car);
    std::set<int> found;
    for (const double azimuth : {0.6, 2.5, -0.6, -2.5}) {
        Orbit orbit;
        orbit.azimuth_rad = azimuth;
        orbit.elevation_rad = 0.25;
        const View view = view_of(fitted(orbit, bounds_of(car->mesh), 1.6), 640, 400);
        for (int y = 0; y < view.height; y += 4) {
            for (int x = 0; x < view.width; x += 4) {
                const auto part = picker.part_at(view, {x + 0.5, y + 0.5});
                if (part) found.insert(*part);
            }
        }
        EXPECT_FALSE(picker.part_at(view, {0.5, 0.5}));
        EXPECT_FALSE(picker.part_at(view, {639.5, 0.5}));
        EXPECT_FALSE(picker.part_at(view, {0.5, 399.5}));
    }
    EXPECT_EQ(found.size(), car->mesh.parts.size());
}

TEST(PartPicker, PicksTheNearestOfWhatAPixelShows) {
    Product made;
    made.mesh = make_sphere({0, 0, 0}, 40.0, 32, "behind");
    append(made.mesh, make_sphere({0, 0, 60}, 10.0, 32, "before"), "");
    const PartPicker picker(std::make_shared<const Product>(std::move(made)));
    const View view = look_at({0, 0, 500}, {0, 0, 0}, 0.3, 300, 200);
    EXPECT_EQ(picker.part_at(view, {150, 100}), 1);
    EXPECT_EQ(picker.part_at(view, {150, 60}), 0);
    EXPECT_FALSE(picker.part_at(view, {20, 100}));
}

TEST(PartPicker, TellsPositionAndNormalOfThePoint) {
    Product made;
    made.mesh = make_sphere({0, 0, 0}, 40.0, 64, "behind");
    append(made.mesh, make_sphere({0, 0, 60}, 10.0, 64, "before"), "");
    const PartPicker picker(std::make_shared<const Product>(std::move(made)));
    const View view = look_at({0, 0, 500}, {0, 0, 0}, 0.3, 300, 200);
    for (const glm::dvec2& pixel : {glm::dvec2(150, 100), glm::dvec2(165, 55)}) {
        const auto point = picker.point_at(view, pixel);
        ASSERT_TRUE(point);
        EXPECT_EQ(picker.part_at(view, pixel), point->part);
        const glm::dvec3 centre = point->part == 1 ? glm::dvec3(0, 0, 60) : glm::dvec3(0.0);
        const double radius = point->part == 1 ? 10.0 : 40.0;
        EXPECT_NEAR(glm::distance(point->position_mm, centre), radius, 0.1);
        EXPECT_NEAR(glm::length(point->normal), 1.0, 1e-9);
        EXPECT_GT(glm::dot(point->normal, point->position_mm - centre), 0.99 * radius);
        const auto back = project(view, point->position_mm);
        ASSERT_TRUE(back);
        EXPECT_NEAR(glm::distance(*back, pixel), 0.0, 1e-3);
    }
    EXPECT_FALSE(picker.point_at(view, {20, 100}));
}

TEST(PartPicker, ASheetFacesWhoeverSeesIt) {
    Product made;
    Mesh& mesh = made.mesh;
    mesh.positions_mm = {{-50, -50, 0}, {50, -50, 0}, {0, 80, 0}};
    mesh.uvs.resize(3);
    mesh.triangles = {{0, 1, 2}};
    mesh.triangle_part = {0};
    mesh.parts = {{"sheet", "", {}, {}}};
    compute_normals(mesh);
    compute_tangents(mesh);
    const PartPicker picker(std::make_shared<const Product>(std::move(made)));
    for (const double side : {-1.0, 1.0}) {
        const View view = look_at({0, 0, side * 500.0}, {0, 0, 0}, 0.3, 300, 200);
        const auto point = picker.point_at(view, {150, 100});
        ASSERT_TRUE(point);
        EXPECT_NEAR(point->normal.z, side, 1e-6);
    }
}

TEST(PartPicker, FindsNothingOutsideThePicture) {
    Product made;
    made.mesh = make_sphere({0, 0, 0}, 40.0, 32, "ball");
    const PartPicker picker(std::make_shared<const Product>(std::move(made)));
    const View view = look_at({0, 0, 60}, {0, 0, 0}, 0.3, 300, 200);
    EXPECT_EQ(picker.part_at(view, {1, 1}), 0);
    EXPECT_FALSE(picker.part_at(view, {-1, 100}));
    EXPECT_FALSE(picker.part_at(view, {300, 100}));
    EXPECT_FALSE(picker.part_at(view, {150, 200.5}));
    EXPECT_FALSE(picker.part_at(view, {std::nan(""), 100}));
    EXPECT_FALSE(picker.part_at(view, {std::numeric_limits<double>::infinity(), 100}));
    EXPECT_THROW(PartPicker(nullptr), std::invalid_argument);
}

}  // namespace
}  // namespace livery
