#include <cmath>
#include <limits>
#include <set>

#include <gtest/gtest.h>

#include "session/library.h"
#include "session/orbit.h"
#include "session/preview_thread.h"

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
