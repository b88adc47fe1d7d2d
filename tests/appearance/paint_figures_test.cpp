// The figures paint people read: against closed forms, a glossmeter's standard, and values from an
// independent computation (Python, from the CIE's tables and a plain sum over both apertures).
#include "appearance/paint_figures.h"

#include <cmath>
#include <numbers>
#include <stdexcept>

#include <gtest/gtest.h>

#include "appearance/bsdf.h"
#include "appearance/material_library.h"
#include "appearance/measured/measured_paint.h"
#include "appearance/model_table.h"
#include "core/spectrum.h"
#include "support/reference_data.h"
#include "support/temporary_folder.h"

namespace livery {
namespace {

Material of_model(ReflectanceModel model) {
    Material material;
    material.name = "probe";
    material.model = model;
    return material;
}

/// Varnish over black.
Material polished(double alpha, double index) {
    Material material = of_model(ReflectanceModel::clearcoat);
    material.diffuse = glm::dvec3(0.0);
    material.f0 = glm::dvec3(0.0);
    material.coat_alpha = alpha;
    material.coat_f0 = std::pow((index - 1.0) / (index + 1.0), 2.0);
    return material;
}

TEST(PaintFigures, OfADiffuserAreItsColourAtEveryAngle) {
    Material grey = of_model(ReflectanceModel::lambert);
    grey.diffuse = glm::dvec3(0.184186518);  // L* 50
    const PaintFigures figures = paint_figures(grey);
    for (const glm::dvec3& lab : figures.lab) {
        EXPECT_NEAR(lab.x, 50.0, 1e-6);
        EXPECT_NEAR(lab.y, 0.0, 1e-9);
        EXPECT_NEAR(lab.z, 0.0, 1e-9);
    }
    ASSERT_TRUE(figures.flop);
    EXPECT_EQ(*figures.flop, 0.0);
    // rho/pi cos times the receptor's solid angle, over the glass.
    const double solid_angle = 4.4 * 11.7 * std::pow(std::numbers::pi / 180.0, 2.0);
    const double expected = 100.0 * 0.184186518 / std::numbers::pi * 0.5 * solid_angle / 0.10005603;
    EXPECT_NEAR(figures.gloss_60 / expected, 1.0, 0.005);
}

TEST(PaintFigures, AtFiveAnglesAreThoseOfAnIndependentComputation) {
    // Phong's lobe is a function of the aspecular angle alone.
    Material phong = of_model(ReflectanceModel::phong);
    phong.diffuse = {0.3, 0.02, 0.05};
    phong.specular = glm::dvec3(0.1);
    phong.exponent = glm::dvec2(20.0);
    const FiveAngleLab expected{{{83.3525, 13.5553, 2.3904},
                                 {55.2977, 25.0640, 4.7591},
                                 {33.8757, 45.2952, 10.6084},
                                 {33.6500, 45.6056, 10.7268},
                                 {33.6500, 45.6056, 10.7268}}};
    const FiveAngleLab found = five_angle_lab(phong);
    for (std::size_t k = 0; k < found.size(); ++k) {
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[k][c], expected[k][c], 2e-4) << k << ' ' << c;
    }
    EXPECT_NEAR(*flop_index(found), 9.93179, 1e-4);
}

TEST(PaintFigures, FlopIsAlmansIndex) {
    const auto of = [](double l15, double l45, double l110) {
        return flop_index({{{l15, 0, 0}, {80, 0, 0}, {l45, 0, 0}, {30, 0, 0}, {l110, 0, 0}}});
    };
    EXPECT_NEAR(*of(120.0, 60.0, 20.0), 13.199036, 1e-6);
    EXPECT_EQ(*of(20.0, 60.0, 30.0), 0.0);  // lighter away from the mirror direction
    EXPECT_FALSE(of(50.0, 0.99, 1.0));
    EXPECT_TRUE(of(50.0, 1.0, 1.0));
    EXPECT_FALSE(of(50.0, std::nan(""), 1.0));
}

TEST(Gloss, OfBlackGlassIsAHundred) {
    for (const double angle : {20.0, 60.0, 85.0}) {
        EXPECT_NEAR(specular_gloss(polished(1e-4, kGlossStandardIndex), angle), 100.0, 0.1);
    }
}

TEST(Gloss, OfVarnishIsFresnels) {
    // Shares of the glass's reflectance.
    EXPECT_NEAR(specular_gloss(polished(1e-4, 1.5), 20.0), 82.045, 0.1);
    EXPECT_NEAR(specular_gloss(polished(1e-4, 1.5), 60.0), 89.137, 0.1);
    EXPECT_NEAR(specular_gloss(polished(1e-4, 1.5), 85.0), 98.975, 0.1);
    // A base of its own interface reads the same, under whichever model.
    for (const auto model : {ReflectanceModel::ggx, ReflectanceModel::cook_torrance}) {
        Material bare = of_model(model);
        bare.diffuse = glm::dvec3(0.0);
        bare.alpha = glm::dvec2(1e-4);
        EXPECT_NEAR(specular_gloss(bare, 60.0), 89.137, 0.2);
    }
}

TEST(Gloss, OfRoughVarnishIsTheSumOverBothApertures) {
    EXPECT_NEAR(specular_gloss(polished(0.02, 1.5), 20.0), 20.746, 0.01);
    EXPECT_NEAR(specular_gloss(polished(0.02, 1.5), 60.0), 61.237, 0.1);
    EXPECT_NEAR(specular_gloss(polished(0.1, 1.5), 60.0), 13.576, 0.02);
    EXPECT_NEAR(specular_gloss(polished(0.1, 1.5), 85.0), 10.927, 0.05);
    EXPECT_NEAR(specular_gloss(polished(0.3, 1.5), 20.0), 0.15098, 5e-4);
}

TEST(Gloss, FallsWithRoughness) {
    for (const double angle : {20.0, 60.0, 85.0}) {
        double before = 1000.0;
        for (const double alpha : {1e-4, 1e-3, 3e-3, 0.01, 0.03, 0.1, 0.3, 1.0}) {
            const double gloss = specular_gloss(polished(alpha, 1.5), angle);
            EXPECT_LT(gloss, before) << alpha;
            EXPECT_GT(gloss, 0.0) << alpha;
            before = gloss;
        }
    }
}

TEST(Gloss, OfAMetalIsAboveTheGlass) {
    // Aluminium (n 1, k 6.5) throws back 0.90 at 60 degrees.
    Material metal = of_model(ReflectanceModel::ggx);
    metal.diffuse = glm::dvec3(0.0);
    metal.f0 = glm::dvec3(0.914);
    metal.alpha = glm::dvec2(1e-4);
    // Schlick's term, which metals have, is within 2% of it.
    EXPECT_NEAR(specular_gloss(metal, 60.0) / (100.0 * 0.90 / 0.10006), 1.0, 0.02);
}

TEST(Gloss, RefusesOtherAngles) {
    for (const double angle : {0.0, 45.0, 60.5, -20.0, std::nan("")}) {
        EXPECT_THROW(specular_gloss(polished(0.1, 1.5), angle), std::invalid_argument);
    }
}

TEST(GlossOptics, FresnelIsFresnels) {
    EXPECT_NEAR(dielectric_reflectance(1.0, 1.5), 0.04, 1e-12);
    EXPECT_NEAR(dielectric_reflectance(0.5, 1.5), 0.0891867, 1e-6);
    EXPECT_NEAR(dielectric_reflectance(0.0, 1.5), 1.0, 1e-12);
    EXPECT_NEAR(fresnel_over_schlick(0.04, 1.0), 1.0, 1e-12);
    EXPECT_NEAR(fresnel_over_schlick(0.04, 0.5), 0.0891867 / 0.07, 1e-5);
    EXPECT_EQ(fresnel_over_schlick(0.0, 0.5), 1.0);
    for (const double cosine : {0.0, 0.3, 1.0}) {
        EXPECT_NEAR(fresnel_over_schlick(1.0, cosine), 1.0, 0.06) << cosine;
    }
}

TEST(PaintFigures, AreFiniteForEveryModelAtItsEnds) {
    for (const ModelInfo& model : formula_models()) {
        for (const bool high : {false, true}) {
            Material material = of_model(model.model);
            for (const char* name : model.parameters) {
                const ParameterInfo& info = parameter_info(name);
                for (double* number : info.in_material(material)) {
                    if (number) *number = high ? info.high : info.low;
                }
            }
            const PaintFigures figures = paint_figures(material);
            for (const glm::dvec3& lab : figures.lab) {
                EXPECT_TRUE(std::isfinite(lab.x + lab.y + lab.z)) << model.name << high;
            }
            EXPECT_TRUE(std::isfinite(figures.gloss_20 + figures.gloss_60)) << model.name << high;
            EXPECT_GE(std::min(figures.gloss_20, figures.gloss_60), 0.0) << model.name << high;
            EXPECT_TRUE(!figures.flop || std::isfinite(*figures.flop)) << model.name << high;
        }
    }
    EXPECT_THROW(paint_figures(of_model(ReflectanceModel::measured)), std::invalid_argument);
}

TEST(PaintFigures, OfMeasuredSpectraAreIntegrated) {
    // A diffuser that reflects one half above 560 nm and nothing below.
    std::string rows = "# a step at 560 nm\n4\n380 555 560 780\n";
    for (double theta = 0.05; theta < 1.5; theta += 0.14) {
        for (double eye = 0.05; eye < 1.5; eye += 0.14) {
            for (double phi = 0.0; phi < 3.2; phi += 0.4) {
                rows += std::to_string(theta) + " 0 " + std::to_string(eye) + " " +
                        std::to_string(phi) + " 0 0 0.159154943 0.159154943\n";
            }
        }
    }
    const TemporaryFolder folder;
    Material step = of_model(ReflectanceModel::measured);
    step.measured = read_measured_paint(folder.write("step.brdf", rows));
    Spectrum half{};
    for (std::size_t k = 36; k < half.size(); ++k) half[k] = 0.5;
    const glm::dvec3 expected = lab10_from_xyz10(xyz10_from_reflectance(half));
    for (const glm::dvec3& lab : five_angle_lab(step)) {
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(lab[c], expected[c], 0.05) << c;
    }
    // From the 2 degree colour alone it would have been another one.
    const glm::dvec3 foretold =
        lab10_from_xyz10(xyz10_from_xyz(xyz_from_reflectance(half, illuminant_d65())));
    EXPECT_GT(glm::length(foretold - expected), 1.0);
}

TEST(PaintFigures, TellMetallicFromSolidPaint) {
    const Material solid = find_material("solid red"), metallic = find_material("silver metallic");
    // Its coat throws back 4.4% of what comes at 25 degrees and 12% at 65: L* falls by that.
    EXPECT_LT(*paint_figures(solid).flop, 1.5);
    EXPECT_GT(*paint_figures(metallic).flop, 5.0);
    EXPECT_GT(paint_figures(solid).gloss_60, 50.0);
    EXPECT_LT(paint_figures(find_material("matte grey")).gloss_60, 5.0);
}

}  // namespace
}  // namespace livery
