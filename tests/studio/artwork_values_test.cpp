// Artwork in plain words: sides, turns, how new ones begin, the order of the list.
#include "studio/artwork/artwork_values.h"

#include <cmath>
#include <set>
#include <stdexcept>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "scene/library.h"

namespace livery {
namespace {

/// Much as the car: long along x, seen from its side.
const Bounds kCar{{-90.0, 10.0, -40.0}, {90.0, 60.0, 40.0}};
const glm::dvec3 kEye{281.0, 425.0, 696.0};

void expect_same(const glm::dvec3& a, const glm::dvec3& b) {
    EXPECT_NEAR(glm::distance(a, b), 0.0, 1e-9) << a.x << " " << a.y << " " << a.z;
}

TEST(NamedSides, AreTheProductsOwn) {
    const auto side = [](const std::string& front, const std::string& name) {
        for (const NamedSide& one : named_sides(front)) {
            if (one.name == name) return -direction_from(one.side);
        }
        return glm::dvec3(0.0);
    };
    // Left is up x front, as one who sits in a car has it.
    const glm::dvec3 up(0.0, 1.0, 0.0);
    const std::vector<std::pair<std::string, glm::dvec3>> fronts{{"+x", {1.0, 0.0, 0.0}},
                                                                 {"-x", {-1.0, 0.0, 0.0}},
                                                                 {"+z", {0.0, 0.0, 1.0}},
                                                                 {"-z", {0.0, 0.0, -1.0}}};
    for (const auto& [name, front] : fronts) {
        EXPECT_EQ(side(name, "front"), front) << name;
        EXPECT_EQ(side(name, "back"), -front) << name;
        EXPECT_EQ(side(name, "left"), glm::cross(up, front)) << name;
        EXPECT_EQ(side(name, "right"), -glm::cross(up, front)) << name;
    }
    EXPECT_EQ(side("", "left"), glm::dvec3(-1.0, 0.0, 0.0));
    EXPECT_EQ(front_of_product("car"), "+x");
    EXPECT_EQ(front_of_product("sphere"), "");
}

TEST(ArtworkWords, NameEveryShapeAndUseOnce) {
    std::set<std::string> labels;
    for (std::size_t i = 0; i < kArtworkShapes.size(); ++i) {
        const Words words = words_of(static_cast<ArtworkShape>(i));
        EXPECT_TRUE(labels.insert(words.label).second) << words.label;
        EXPECT_FALSE(words.meaning.empty());
    }
    for (std::size_t i = 0; i < kPictureUses.size(); ++i) {
        const Words words = words_of(static_cast<PictureUse>(i));
        EXPECT_TRUE(labels.insert(words.label).second) << words.label;
        EXPECT_FALSE(words.label.empty());
    }
}

TEST(ArtworkSides, AreThoseOfTheLightPanel) {
    const auto angles = [](Side side) { return angles_of(from_side(ArtworkPlace{}, side)); };
    EXPECT_NEAR(angles(Side::right).azimuth_deg, 90.0, 1e-9);
    EXPECT_NEAR(angles(Side::left).azimuth_deg, -90.0, 1e-9);
    EXPECT_NEAR(angles(Side::back).azimuth_deg, 0.0, 1e-9);
    EXPECT_NEAR(angles(Side::front).azimuth_deg, 180.0, 1e-9);
    EXPECT_NEAR(angles(Side::above).elevation_deg, 90.0, 1e-9);
}

TEST(ArtworkSides, KeepCentreTurnAndBothSides) {
    ArtworkPlace place;
    place.centre_mm = {1.0, 2.0, 3.0};
    place.through = false;
    place = with_turn(place, 30.0);
    for (const Side side : kSides) {
        const ArtworkPlace there = from_side(place, side);
        EXPECT_EQ(side_of(there), side);
        EXPECT_EQ(there.centre_mm, place.centre_mm);
        EXPECT_FALSE(there.through);
        EXPECT_NEAR(turn_deg_of(there), 30.0, 1e-9);
    }
    EXPECT_FALSE(side_of(from_angles(place, {45.0, 0.0})));
}

TEST(ArtworkTurn, IsCounterClockwiseAsItIsSeen) {
    ArtworkPlace place = from_side(ArtworkPlace{}, Side::front);
    expect_same(place.up, {0.0, 1.0, 0.0});
    place = with_turn(place, 90.0);
    expect_same(place.up, {-1.0, 0.0, 0.0});
    for (const double turn : {-179.0, -90.0, -1.0, 0.0, 45.0, 180.0}) {
        EXPECT_NEAR(turn_deg_of(with_turn(place, turn)), turn, 1e-9);
    }
}

TEST(ArtworkAngles, TurnThePatternSteadily) {
    ArtworkPlace place = with_turn(from_side(ArtworkPlace{}, Side::front), 20.0);
    // Beyond 64 degrees "upright" is another direction; the pattern must not jump there.
    for (double elevation = 0.0; elevation < 89.0; elevation += 1.0) {
        const Angles angles{130.0, elevation};
        const ArtworkPlace next = from_angles(place, angles);
        EXPECT_NEAR(angles_of(next).azimuth_deg, 130.0, 1e-6);
        EXPECT_NEAR(angles_of(next).elevation_deg, elevation, 1e-6);
        EXPECT_NEAR(glm::dot(next.up, next.direction), 0.0, 1e-9);
        if (elevation > 0.0) {
            EXPECT_GT(glm::dot(next.up, plane_of(place).t_axis), std::cos(0.02));
        }
        place = next;
    }
}

TEST(NewArtwork, LiesOnTheMiddleFromTheSideThatIsSeen) {
    const Artwork stripes = new_artwork(ArtworkShape::stripes, "body", kCar, kEye, {});
    EXPECT_EQ(stripes.name, "stripes");
    EXPECT_EQ(stripes.part, "body");
    EXPECT_EQ(side_of(stripes.place), Side::front);
    expect_same(stripes.place.centre_mm, {0.0, 35.0, 0.0});
    EXPECT_TRUE(stripes.place.through);
    EXPECT_GT(stripes.size_mm, 5.0);
    EXPECT_LT(stripes.size_mm, 90.0);
    const Artwork from_behind =
        new_artwork(ArtworkShape::dots, "body", kCar, {-100.0, 100.0, -700.0}, {});
    EXPECT_EQ(side_of(from_behind.place), Side::back);
}

TEST(NewArtwork, OnWhatIsFlatComesFromAboveButForTwoTones) {
    const Bounds flat{{-50.0, 0.0, -80.0}, {50.0, 8.0, 80.0}};
    const auto side = [&](ArtworkShape shape) {
        return side_of(new_artwork(shape, "*", flat, kEye, {}).place);
    };
    EXPECT_EQ(side(ArtworkShape::checks), Side::above);
    EXPECT_EQ(side(ArtworkShape::picture), Side::above);
    EXPECT_NE(side(ArtworkShape::half), Side::above);
}

TEST(NewArtwork, APictureFitsAndIsOnOneSide) {
    const Artwork wide = new_artwork(ArtworkShape::picture, "body", kCar, kEye, {}, 0.1);
    EXPECT_NEAR(wide.size_mm, 90.0, 1e-9);
    EXPECT_FALSE(wide.place.through);
    EXPECT_EQ(wide.use, PictureUse::colours);
    const Artwork high = new_artwork(ArtworkShape::picture, "body", kCar, kEye, {}, 10.0);
    EXPECT_LE(high.size_mm * 10.0, 50.0);
    // A part that is a sheet or a point has a size all the same.
    const Bounds sheet{{0.0, 0.0, 0.0}, {0.0, 10.0, 40.0}}, point{};
    for (const Bounds& bounds : {sheet, point}) {
        for (std::size_t i = 0; i + 1 < kArtworkShapes.size(); ++i) {
            const auto shape = static_cast<ArtworkShape>(i);
            EXPECT_NO_THROW(check_artwork(new_artwork(shape, "*", bounds, kEye, {})));
        }
        EXPECT_GT(new_artwork(ArtworkShape::picture, "*", bounds, kEye, {}).size_mm, 0.0);
    }
}

TEST(NewArtwork, HasANameOfItsOwn) {
    std::vector<Artwork> list{new_artwork(ArtworkShape::half, "*", kCar, kEye, {})};
    EXPECT_EQ(list[0].name, "two tones");
    list.push_back(new_artwork(ArtworkShape::half, "*", kCar, kEye, list));
    EXPECT_EQ(list[1].name, "two tones 2");
    list = with_copy(list, 0);
    EXPECT_EQ(list[1].name, "two tones 3");
    EXPECT_EQ(list[2].name, "two tones 2");
    EXPECT_EQ(list[1].place, list[0].place);
}

TEST(ArtworkList, ChangesItsOrder) {
    std::vector<Artwork> list(3);
    for (std::size_t i = 0; i < 3; ++i) list[i].name = std::string(1, static_cast<char>('a' + i));
    const auto names = [](const std::vector<Artwork>& of) {
        std::string text;
        for (const Artwork& one : of) text += one.name;
        return text;
    };
    EXPECT_EQ(names(moved(list, 0, 1)), "bac");
    EXPECT_EQ(names(moved(list, 2, 0)), "cab");
    EXPECT_EQ(names(moved(list, 1, 1)), "abc");
    EXPECT_THROW(moved(list, 0, 3), std::invalid_argument);
    EXPECT_THROW(with_copy(list, 3), std::invalid_argument);
}

TEST(WithShape, LeavesNothingThatTheShapeDoesNotRead) {
    Artwork picture = new_artwork(ArtworkShape::picture, "*", kCar, kEye, {});
    picture.picture = "badge.png";
    picture.repeat = picture.place.by_uv = true;
    picture.paint = "solid red";
    const Artwork dots = with_shape(picture, ArtworkShape::dots);
    EXPECT_NO_THROW(check_artwork(dots));
    EXPECT_EQ(dots.paint, "solid red");
    EXPECT_EQ(dots.size_mm, picture.size_mm);
    EXPECT_FALSE(dots.repeat);
}

TEST(WithUse, LeavesNothingThatTheUseDoesNotRead) {
    Artwork picture = new_artwork(ArtworkShape::picture, "*", kCar, kEye, {});
    picture.picture = "badge.png";
    picture.paint = "solid red";
    Artwork relief = with_use(picture, PictureUse::relief);
    EXPECT_NO_THROW(check_artwork(relief)) << "a relief has no paint";
    relief.depth = -3.0;
    EXPECT_EQ(with_use(relief, PictureUse::colours).depth, Artwork{}.depth);
    EXPECT_EQ(with_use(picture, PictureUse::cover).paint, "solid red");
}

TEST(PutOn, FacesTheSurfaceAndStaysTurned) {
    Artwork artwork = new_artwork(ArtworkShape::picture, "body", kCar, kEye, {});
    artwork.place = with_turn(artwork.place, -15.0);
    const glm::dvec3 normal = glm::normalize(glm::dvec3(0.2, 0.3, 1.0));
    const Artwork there = put_on(artwork, "glass", {5.0, 50.0, 30.0}, normal);
    EXPECT_EQ(there.part, "glass");
    EXPECT_EQ(there.place.centre_mm, glm::dvec3(5.0, 50.0, 30.0));
    expect_same(plane_of(there.place).toward, normal);
    EXPECT_NEAR(turn_deg_of(there.place), -15.0, 1e-9);
    EXPECT_FALSE(there.place.through);
    artwork.part = "*";
    EXPECT_EQ(put_on(artwork, "glass", {}, normal).part, "*");
}

TEST(PaintOver, DiffersFromWhatLiesBelow) {
    EXPECT_EQ(paint_over(90.0), "solid black");
    EXPECT_EQ(paint_over(10.0), "solid ivory");
}

TEST(PartBounds, AreOfOnePart) {
    Mesh mesh = make_sphere({0, 0, 0}, 40.0, 16, "large");
    append(mesh, make_sphere({0, 0, 60}, 10.0, 16, "small"), "");
    EXPECT_NEAR(bounds_of_part(mesh, "small").low.z, 50.0, 0.5);
    EXPECT_NEAR(bounds_of_part(mesh, "large").high.z, 40.0, 0.5);
    EXPECT_NEAR(bounds_of_part(mesh, "*").high.z, 70.0, 0.5);
}

}  // namespace
}  // namespace livery
