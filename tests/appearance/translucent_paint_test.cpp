// Translucent materials as paints: their files, and what they look like where light leaves at once.
#include "appearance/subsurface/translucent_paint.h"

#include <gtest/gtest.h>

#include "appearance/bsdf.h"
#include "appearance/material_json.h"
#include "appearance/material_library.h"
#include "appearance/paint_bsdf.h"
#include "appearance/parameter_table.h"
#include "appearance/subsurface/exact_totals.h"
#include "core/error.h"
#include "support/temporary_folder.h"

namespace livery {
namespace {

const char* kFile = R"({"format_version": 1, "name": "wax", "family": "candles",
    "model": "translucent",
    "parameters": {"sigma_a_per_mm": [0.001, 0.004, 0.02], "sigma_s_per_mm": 4, "g": 0.5,
                   "eta": 1.44, "alpha": 0.1}})";

TEST(TranslucentPaint, IsReadAndWritten) {
    const TemporaryFolder folder;
    const Material wax = parse_material(kFile, folder / "wax.json");
    ASSERT_TRUE(wax.medium);
    EXPECT_EQ(wax.model, ReflectanceModel::translucent);
    EXPECT_EQ(wax.family, "candles");
    EXPECT_EQ(wax.medium->sigma_s_prime_per_mm, glm::dvec3(2.0));
    EXPECT_EQ(wax.medium->sigma_a_per_mm, glm::dvec3(0.001, 0.004, 0.02));
    EXPECT_EQ(wax.alpha, glm::dvec2(0.1));
    write_material_file(folder / "copy.json", wax);
    const Material copy = read_paint_file(folder / "copy.json");
    EXPECT_TRUE(same_reflectance(wax, copy));
    TranslucentMaterial other = *wax.medium;
    other.sigma_a_per_mm.y *= 1.01;
    EXPECT_FALSE(same_reflectance(wax, translucent_paint(other, 0.1)));
    TranslucentMaterial sheet = *wax.medium;
    sheet.thickness_mm = 2.0;
    const Material thin = translucent_paint(sheet, 0.1);
    EXPECT_FALSE(same_reflectance(wax, thin));
    write_material_file(folder / "thin.json", thin);
    EXPECT_TRUE(same_reflectance(read_paint_file(folder / "thin.json"), thin));
}

TEST(TranslucentPaint, IsRefusedWithFieldAndRange) {
    const auto refuses = [](std::string from, const std::string& to, const std::string& field) {
        std::string text = kFile;
        text.replace(text.find(from), from.size(), to);
        try {
            parse_material(text, "wax.json");
            ADD_FAILURE() << text;
        } catch (const FileError& error) {
            EXPECT_NE(std::string(error.what()).find(field), std::string::npos) << error.what();
        }
    };
    refuses("\"eta\": 1.44", "\"eta\": 3", "eta");
    refuses("\"eta\": 1.44,", "", "eta");
    refuses("\"g\": 0.5", "\"g\": 1", "g");
    refuses("0.004, 0.02]", "-0.1, 0.02]", "sigma_a_per_mm");
    refuses("0.004, 0.02]", "0.02]", "sigma_a_per_mm");
    refuses("\"alpha\": 0.1", "\"alpha\": 2", "alpha");
    refuses("\"alpha\": 0.1", "\"thickness_mm\": 0", "thickness_mm");
    refuses("\"alpha\": 0.1", "\"f0\": 0.04", "f0");
}

TEST(TranslucentPaint, ShippedMediaArePaintsByTheirName) {
    const auto library = read_paint_library();
    EXPECT_EQ(library->media.size(), 52u);
    for (const char* name : {"marble", "skim milk", "Skim-Milk", "white pvc", "candle wax"}) {
        const Material paint = find_material(name, *library);
        EXPECT_EQ(paint.model, ReflectanceModel::translucent) << name;
        ASSERT_TRUE(paint.medium) << name;
        EXPECT_TRUE(look_up(*library, name).problem.empty()) << name;
    }
    EXPECT_THROW(find_material("marbel", *library), FileError);
    EXPECT_EQ(library->nearest("marbel", 1).at(0), "marble");
}

TEST(TranslucentPaint, ReturnsTheExactTotalUnderItsBoundary) {
    const Material paint = find_material("marble");
    const Material opaque = albedo_paint(paint);
    EXPECT_EQ(opaque.model, ReflectanceModel::ggx);
    EXPECT_FALSE(opaque.medium);
    for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(opaque.diffuse[c], exact_totals(medium_of(*paint.medium, c)).reflectance, 1e-9);
    }
    EXPECT_NEAR(opaque.f0.x, 0.04, 1e-12);
    // Of a green beam on it 76.7% comes back (Jensen et al. 2001's marble, adding and doubling)
    EXPECT_NEAR(opaque.diffuse.y * 0.96, 0.767, 1e-3);
    const glm::vec3 wi(0.6f, 0.0f, 0.8f), wo(0.0f, 0.28f, 0.96f);
    EXPECT_EQ(evaluate(bsdf_of(paint), wi, wo), evaluate(bsdf_of(opaque), wi, wo));
    EXPECT_TRUE(same_reflectance(albedo_paint(opaque), opaque));
}

TEST(TranslucentPaint, IsFiniteWhereNothingIsMet) {
    for (const double a : {0.0, 1e-300, 1e6}) {
        for (const double s : {0.0, 1e-300, 1e6}) {
            for (const double eta : {1.0, 2.5}) {
                TranslucentMaterial medium;
                medium.sigma_a_per_mm = glm::dvec3(a);
                medium.sigma_s_prime_per_mm = glm::dvec3(s);
                medium.eta = eta;
                const glm::dvec3 albedo = entering_albedo(medium);
                EXPECT_TRUE(albedo.x >= 0.0 && albedo.x <= 1.0) << a << " " << s << " " << eta;
                EXPECT_NO_THROW(bsdf_of(translucent_paint(medium)));
            }
        }
    }
}

TEST(TranslucentPaint, IsScaledToTheMockUp) {
    const TranslucentMaterial marble = read_translucent_material("marble");
    const TranslucentMaterial small = on_mock_up(marble, 25.0);
    EXPECT_EQ(small.sigma_a_per_mm, 25.0 * marble.sigma_a_per_mm);
    EXPECT_EQ(small.sigma_s_prime_per_mm, 25.0 * marble.sigma_s_prime_per_mm);
    EXPECT_EQ(entering_albedo(small), entering_albedo(marble));
}

TEST(TranslucentPaint, LengthAndColourAreEditedApart) {
    for (const char* name : {"marble", "skim milk", "ketchup", "skin 1"}) {
        SCOPED_TRACE(name);
        TranslucentMaterial medium = read_translucent_material(name);
        const glm::dvec3 colour = entering_albedo(medium);
        const TranslucentMaterial longer = with_mean_free_path(medium, 3.0);
        EXPECT_NEAR(mean_free_path_mm(longer), 3.0, 1e-12);
        // A total knows no length, but for rounding
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(entering_albedo(longer)[c], colour[c], 1e-9);
        for (const glm::dvec3& wanted :
             {glm::dvec3(0.9, 0.5, 0.1), glm::dvec3(0.999, 0.02, 0.7), glm::dvec3(0.3)}) {
            medium.g = wanted.x == 0.3 ? 0.6 : 0.0;
            const TranslucentMaterial made = with_entering_albedo(medium, wanted);
            for (int c = 0; c < 3; ++c) {
                EXPECT_NEAR(entering_albedo(made)[c], wanted[c], 1e-4) << c;
                EXPECT_NEAR(made.sigma_a_per_mm[c] + made.sigma_s_prime_per_mm[c],
                            medium.sigma_a_per_mm[c] + medium.sigma_s_prime_per_mm[c],
                            1e-12);
            }
        }
    }
}

TEST(TranslucentPaint, TakesTheNearestColourThereIs) {
    TranslucentMaterial clear;
    clear.sigma_a_per_mm = clear.sigma_s_prime_per_mm = glm::dvec3(0.0);
    const TranslucentMaterial made = with_entering_albedo(clear, {1.5, -0.2, 0.5});
    EXPECT_EQ(made.sigma_a_per_mm.x, 0.0);
    EXPECT_EQ(made.sigma_s_prime_per_mm.y, 0.0);
    EXPECT_NEAR(entering_albedo(made).z, 0.5, 1e-4);
    EXPECT_EQ(with_mean_free_path(clear, 2.0).sigma_a_per_mm, clear.sigma_a_per_mm);
    EXPECT_THROW(with_mean_free_path(clear, 0.0), std::invalid_argument);
    EXPECT_THROW(with_mean_free_path(clear, -1.0), std::invalid_argument);
}

}  // namespace
}  // namespace livery
