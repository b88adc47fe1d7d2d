// A paint's finish in another colour: reached where it can be, and said where it cannot.
#include "appearance/fit/recolour.h"

#include <cmath>
#include <limits>
#include <stdexcept>

#include <gtest/gtest.h>

#include "appearance/material_library.h"
#include "appearance/model_table.h"
#include "appearance/paint_bsdf.h"
#include "appearance/paint_colour.h"
#include "appearance/paint_figures.h"
#include "core/colour.h"
#include "support/message_of.h"

namespace livery {
namespace {

TEST(Recolour, ReachesColoursOfPaint) {
    for (const char* finish : {"solid red", "matte grey", "solid black", "silver metallic"}) {
        for (const char* colour :
             {"#a01c24", "#1e3c78", "#205030", "#c8b068", "lab:50,0,0", "lab:45,-10,-20"}) {
            const glm::dvec3 lab = parse_colour(colour);
            const Recoloured made = with_colour(find_material(finish), lab);
            EXPECT_TRUE(made.reached) << finish << ' ' << colour << ": " << made.why_not;
            EXPECT_LE(made.de00, kColourReached);
            EXPECT_NEAR(ciede2000(lab, five_angle_lab(made.material)[kFaceAngle]), made.de00, 1e-9);
            EXPECT_TRUE(made.why_not.empty());
        }
    }
}

TEST(Recolour, KeepsTheFinish) {
    const Material silver = find_material("silver metallic");
    const Recoloured made = with_colour(silver, parse_colour("lab:30,5,-30"));
    EXPECT_TRUE(made.reached) << made.why_not;
    EXPECT_EQ(made.material.model, silver.model);
    EXPECT_EQ(made.material.alpha, silver.alpha);
    EXPECT_EQ(made.material.coat_alpha, silver.coat_alpha);
    EXPECT_EQ(made.material.family, silver.family);
    EXPECT_EQ(made.material.name, silver.name);
    EXPECT_TRUE(made.material.file.empty());
    EXPECT_EQ(without_colour_record(made.material.provenance),
              "designed: the finish of 'silver metallic'");
    // Flakes and pigment keep their share of each other, so it flops as before.
    EXPECT_NEAR(*paint_figures(made.material).flop / *paint_figures(silver).flop, 1.0, 0.25);
    EXPECT_NEAR(specular_gloss(made.material, 60.0) / specular_gloss(silver, 60.0), 1.0, 0.25);
    // The binder of a plastic is not tinted.
    const Material grey = find_material("matte grey");
    EXPECT_NEAR(with_colour(grey, parse_colour("#304080")).material.f0.x, grey.f0.x, 1e-12);
}

TEST(Recolour, GivesBackItsOwnColour) {
    const auto library = read_paint_library();
    for (const Material& paint : library->shipped) {
        if (paint.family == "chrome") continue;  // black at 45 degrees
        const glm::dvec3 lab = five_angle_lab(paint)[kFaceAngle];
        const Recoloured made = with_colour(paint, lab);
        // A film keeps its own colour, whatever the pigment: some saturated ones cannot be had
        // again.
        const bool within = paint.film_nm > 0.0 ? made.de00 < 2.0 * kColourReached : made.reached;
        EXPECT_TRUE(within) << paint.name << ' ' << made.de00 << ' ' << made.why_not;
    }
}

TEST(Recolour, SaysWhyNot) {
    const auto tried = [](const char* finish, const char* colour) {
        const Recoloured made = with_colour(find_material(finish), parse_colour(colour));
        EXPECT_FALSE(made.reached) << finish << ' ' << colour;
        EXPECT_GT(made.de00, kColourReached);
        EXPECT_NO_THROW(bsdf_of(made.material));
        return made.why_not;
    };
    EXPECT_NE(tried("solid red", "lab:120,0,0").find("too light for the finish of 'solid red'"),
              std::string::npos);
    EXPECT_NE(tried("chrome trim", "lab:60,0,0").find("too light"), std::string::npos);
    EXPECT_NE(tried("solid red", "lab:50,-150,20").find("more saturated"), std::string::npos);
    EXPECT_NE(tried("matte grey", "lab:1,0,0").find("too dark"), std::string::npos);
}

TEST(Recolour, RecordsWhatWasAskedWhatCameAndHowFarApart) {
    const glm::dvec3 asked{90.0, -60.0, 80.0};
    const Recoloured missed = with_colour(find_material("silver metallic"), asked);
    ASSERT_FALSE(missed.reached);
    const auto record = colour_record(missed.material.provenance);
    ASSERT_TRUE(record) << missed.material.provenance;
    EXPECT_EQ(record->asked_lab10, asked);
    // Written with one decimal, the difference with two.
    const glm::dvec3 came = five_angle_lab(missed.material)[kFaceAngle];
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(record->came_lab10[c], came[c], 0.051);
    EXPECT_NEAR(record->de00, ciede2000(asked, came), 0.0051);
    EXPECT_GT(record->de00, 5.0);
    EXPECT_FALSE(colour_record("designed: by hand"));
    EXPECT_FALSE(colour_record(missed.material.provenance + " and more"));
    EXPECT_EQ(without_colour_record("designed: by hand"), "designed: by hand");
}

TEST(Recolour, RefusesWhatHasNoColour) {
    Material measured;
    measured.name = "panel";
    measured.model = ReflectanceModel::measured;
    EXPECT_NE(message_of([&] {
                  with_colour(measured, {50, 0, 0});
              }).find("'panel' is measured"),
              std::string::npos);
    EXPECT_THROW(with_colour(Material{}, {std::nan(""), 0, 0}), std::invalid_argument);
}

TEST(Recolour, TakesEveryModel) {
    for (const ModelInfo& model : formula_models()) {
        Material paint;
        paint.name = model.name;
        paint.model = model.model;
        const Recoloured made = with_colour(paint, parse_colour("lab:45,20,-15"));
        EXPECT_TRUE(made.reached) << model.name << ' ' << made.de00 << ' ' << made.why_not;
    }
}

TEST(Recolour, AnotherModelKeepsTheColour) {
    const glm::dvec3 asked = parse_colour("lab:30,40,20");
    const Material typed = with_colour(find_material("solid red"), asked).material;
    const Material plain = find_material("solid green");
    for (const ModelInfo& model : formula_models()) {
        const Material made = with_model(typed, model.model);
        EXPECT_EQ(made.model, model.model);
        EXPECT_EQ(made.name, typed.name);
        const glm::dvec3 lab = five_angle_lab(made)[kFaceAngle];
        EXPECT_LE(ciede2000(asked, lab), kColourReached)
            << model.name << ": " << lab.x << ' ' << lab.y << ' ' << lab.z;
        const Material other = with_model(plain, model.model);
        EXPECT_LE(ciede2000(five_angle_lab(plain)[kFaceAngle], five_angle_lab(other)[kFaceAngle]),
                  kColourReached)
            << model.name;
        EXPECT_EQ(other.provenance, plain.provenance) << "nobody asked for a colour";
    }
}

}  // namespace
}  // namespace livery
