// What the panel says of a paint's parameters, and colours as people type them.
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "core/colour.h"
#include "studio/kit/widgets.h"
#include "studio/paint/paint_rows.h"

namespace livery {
namespace {

TEST(Summary, HoldsTheModelsOwnParameters) {
    Material material;
    material.diffuse = {0.1, 0.2, 0.3};
    EXPECT_EQ(summary_of(material), "Plain diffuse\nDiffuse colour 0.1 0.2 0.3");
    material.model = ReflectanceModel::clearcoat;
    material.alpha = {0.1, 0.4};
    const std::string text = summary_of(material);
    EXPECT_NE(text.find("0.1 along, 0.4 across"), std::string::npos) << text;
    EXPECT_EQ(text.find("Coat tint"), std::string::npos) << text;
    EXPECT_EQ(text.find("Glint"), std::string::npos) << text;
    material.model = ReflectanceModel::car_paint;
    material.glint_density_per_mm2 = 1000.0;
    EXPECT_NE(summary_of(material).find("\nGlints physical"), std::string::npos);
    material.glint_scale = 25.0;
    EXPECT_NE(summary_of(material).find("\nGlints exaggerated 25 times"), std::string::npos);
}

TEST(PaintProblem, NamesTheParameter) {
    Material material;
    material.name = "mine";
    EXPECT_FALSE(paint_problem(material));
    material.diffuse = {-0.02, 0.4, 0.1};  // outside Rec.709, inside the working space
    EXPECT_FALSE(paint_problem(material));
    material.diffuse = {2.0, 0.0, 0.0};
    ASSERT_TRUE(paint_problem(material));
    EXPECT_NE(paint_problem(material)->find("diffuse"), std::string::npos);
    material.diffuse = {std::nan(""), 0.0, 0.0};
    EXPECT_TRUE(paint_problem(material));
}

TEST(Hex, ComesBack) {
    for (const char* text : {"#000000", "#ffffff", "#a0b1c2", "#010203", "#7f8081"}) {
        const auto colour = colour_of_hex(text);
        ASSERT_TRUE(colour) << text;
        EXPECT_EQ(hex_of(*colour), text);
    }
    EXPECT_EQ(*colour_of_hex(" FFF "), glm::dvec3(1.0));
    EXPECT_EQ(hex_of(*colour_of_hex("abc")), "#aabbcc");
    EXPECT_NEAR(colour_of_hex("#bcbcbc")->x, 0.5029, 1e-3);
    for (const char* text : {"", "#", "#12345", "#1234567", "#gggggg", "red", "#-1-1-1"}) {
        EXPECT_FALSE(colour_of_hex(text)) << text;
    }
}

TEST(Hex, ClipsWhatSrgbCannotSay) {
    EXPECT_EQ(hex_of({-0.5, 2.0, 0.0}), "#00ff00");
    EXPECT_FALSE(in_srgb({-0.001, 0.5, 0.5}));
    EXPECT_FALSE(in_srgb({0.5, 1.001, 0.5}));
    EXPECT_FALSE(in_srgb({0.5, std::nan(""), 0.5}));
    EXPECT_TRUE(in_srgb({0.0, 1.0, 0.5}));
}

TEST(LibraryOrigin, IsWhatTheNumberStandsBehind) {
    PaintLibrary library;
    library.shipped.resize(1);
    library.shipped[0].name = "solid red";
    library.users.resize(1);
    library.users[0].name = "mine";
    ASSERT_NE(library_origin("solid red 2", library), nullptr);
    EXPECT_EQ(library_origin("Solid-Red 13", library)->name, "solid red");
    EXPECT_EQ(library_origin("mine 2", library)->name, "mine");
    for (const char* none : {"solid red", "solid red2", "2", " 2", "", "hers 2", "solid red 2b"}) {
        EXPECT_EQ(library_origin(none, library), nullptr) << none;
    }
}

}  // namespace
}  // namespace livery
