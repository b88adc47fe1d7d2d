#include <gtest/gtest.h>

#include "appearance/material_library.h"
#include "appearance/paint_figures.h"
#include "core/colour.h"
#include "studio/users_library.h"

namespace livery {
namespace {

TEST(ColourIn, TakesWholeColoursAlone) {
    ASSERT_TRUE(colour_in("lab:45,30,-20"));
    EXPECT_EQ(*colour_in("lab:45,30,-20"), glm::dvec3(45.0, 30.0, -20.0));
    for (const char* text : {"#b01020", "1a4f9c", "rgb(26, 79, 156)", "tomato", "gold"}) {
        EXPECT_TRUE(colour_in(text)) << text;
    }
    for (const char* text : {"", "rot", "#b010", "lab:45,", "lab:", "xyz:1,2", "45,30,-20"}) {
        EXPECT_FALSE(colour_in(text)) << text;
    }
}

TEST(FindPaints, TakesANameForAColourOnlyWhereNoPaintHasIt) {
    const auto paints = read_paint_library()->shipped;
    const auto near = [&](const char* colour) {
        std::vector<std::size_t> places;
        for (const NearPaint& one : find_near_paints(paints, *colour_in(colour), "")) {
            places.push_back(one.index);
        }
        return places;
    };
    EXPECT_EQ(find_paints(paints, "gold", ""), search_paints(paints, "gold", ""));
    EXPECT_EQ(find_paints(paints, "#ffd700", ""), near("gold"));
    EXPECT_EQ(find_paints(paints, "tomato", ""), near("tomato"));
    EXPECT_EQ(find_paints(paints, "1a4f9c", ""), near("#1a4f9c"));
    EXPECT_TRUE(is_marked_colour("RGB(1,2,3)"));
    EXPECT_FALSE(is_marked_colour("rgb"));
    EXPECT_FALSE(is_marked_colour("gold"));
}

TEST(DrawnFace, IsTheFiveAngleOneOfAFormula) {
    const auto library = read_paint_library();
    for (const Material& paint : library->shipped) {
        const glm::dvec3 face = five_angle_lab(paint)[kFaceAngle];
        EXPECT_LT(ciede2000(drawn_face_lab(paint), face), 1e-6) << paint.name;
    }
}

TEST(FindPaints, AnswersAColourWithTheNearestOfTheFamily) {
    const auto paints = read_paint_library()->shipped;
    const auto text = [](glm::dvec3 lab) {
        return "lab:" + std::to_string(lab.x) + "," + std::to_string(lab.y) + "," +
               std::to_string(lab.z);
    };
    for (const std::size_t k : {std::size_t{0}, paints.size() / 2, paints.size() - 1}) {
        const auto found = find_paints(paints, text(drawn_face_lab(paints[k])), "");
        ASSERT_FALSE(found.empty());
        EXPECT_EQ(found.front(), k);
        EXPECT_LE(found.size(), kNearestShown);
        for (const std::size_t one : find_paints(paints, "#808080", paints[k].family)) {
            EXPECT_EQ(paints[one].family, paints[k].family);
        }
    }
    EXPECT_EQ(find_paints(paints, "", "").size(), paints.size());
}

}  // namespace
}  // namespace livery
