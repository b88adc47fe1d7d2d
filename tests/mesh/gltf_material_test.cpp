// What becomes of glTF's materials.

#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "appearance/bsdf.h"
#include "mesh/gltf_builder.h"
#include "mesh/mesh.h"
#include "scene/look.h"
#include "scene/scene.h"
#include "support/file_error.h"
#include "support/temporary_folder.h"

namespace livery {
namespace {

class GltfMaterial : public ::testing::Test {
  protected:
    /// The part that wears a material with these members.
    Part part_of(const char* members) {
        GltfBuilder plate = make_plate();
        plate.json["materials"] = Json::array({Json::parse(members)});
        plate.json["materials"][0]["name"] = "skin";
        if (plate.json["materials"][0].contains("extensions")) {
            plate.json["extensionsUsed"] = Json::array();
            for (const auto& [name, member] : plate.json["materials"][0]["extensions"].items()) {
                plate.json["extensionsUsed"].push_back(name);
            }
        }
        plate.json["textures"] = Json::array({Json::object()});
        plate.primitive()["material"] = 0;
        notes_.clear();
        return load_mesh(folder_.write("mesh.glb", plate.glb()), &notes_).parts.at(0);
    }
    Material paint_of(const char* members) {
        const Part part = part_of(members);
        EXPECT_TRUE(part.paint) << members;
        return part.paint.value_or(Material());
    }
    ::testing::AssertionResult fails(const char* members,
                                     std::initializer_list<std::string_view> parts) {
        return fails_with([&] { part_of(members); }, parts);
    }

    TemporaryFolder folder_;
    std::vector<std::string> notes_;
};

TEST_F(GltfMaterial, MetallicAndRoughBecomeGgx) {
    const Material plastic = paint_of(R"({"pbrMetallicRoughness":
        {"baseColorFactor": [0.8, 0.4, 0.2, 1], "metallicFactor": 0, "roughnessFactor": 0.5}})");
    EXPECT_EQ(plastic.model, ReflectanceModel::ggx);
    EXPECT_EQ(plastic.name, "skin");
    EXPECT_EQ(plastic.diffuse, glm::dvec3(0.8, 0.4, 0.2));
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(plastic.f0[c], 0.04, 1e-12);
    EXPECT_EQ(plastic.alpha, glm::dvec2(0.25));  // roughness squared
    EXPECT_TRUE(notes_.empty());

    const Material copper = paint_of(R"({"pbrMetallicRoughness":
        {"baseColorFactor": [0.9, 0.6, 0.4, 1], "roughnessFactor": 0.2}})");
    EXPECT_EQ(copper.diffuse, glm::dvec3(0.0));
    EXPECT_EQ(copper.f0, glm::dvec3(0.9, 0.6, 0.4));
    EXPECT_NEAR(copper.alpha.x, 0.04, 1e-12);

    const Material half = paint_of(R"({"pbrMetallicRoughness":
        {"baseColorFactor": [0.6, 0.6, 0.6, 1], "metallicFactor": 0.5, "roughnessFactor": 0}})");
    EXPECT_NEAR(half.diffuse.x, 0.3, 1e-12);
    EXPECT_NEAR(half.f0.x, 0.5 * (0.04 + 0.6), 1e-12);
    EXPECT_EQ(half.alpha, glm::dvec2(0.001));  // no lamp shows in a perfect mirror
}

TEST_F(GltfMaterial, PlainColoursStayPlain) {
    EXPECT_FALSE(part_of("{}").paint);
    const Part part =
        part_of(R"({"pbrMetallicRoughness": {"baseColorFactor": [0.1, 0.2, 0.3, 1]}})");
    EXPECT_FALSE(part.paint);
    EXPECT_EQ(part.base_colour_rec709, glm::dvec3(0.1, 0.2, 0.3));
}

TEST_F(GltfMaterial, ClearcoatBecomesOurs) {
    const Material paint = paint_of(R"({"pbrMetallicRoughness":
        {"baseColorFactor": [0.5, 0.1, 0.1, 1], "metallicFactor": 0, "roughnessFactor": 0.6},
        "extensions": {"KHR_materials_clearcoat":
            {"clearcoatFactor": 0.5, "clearcoatRoughnessFactor": 0.1}}})");
    EXPECT_EQ(paint.model, ReflectanceModel::clearcoat);
    EXPECT_NEAR(paint.alpha.x, 0.36, 1e-12);
    EXPECT_NEAR(paint.coat_alpha, 0.01, 1e-12);
    EXPECT_NEAR(paint.coat_f0, 0.02, 1e-12);
    EXPECT_EQ(paint.family, "solid");
    EXPECT_TRUE(notes_.empty()) << notes_.front();
    // Without a factor there is no coat.
    EXPECT_EQ(paint_of(R"({"extensions": {"KHR_materials_clearcoat": {}}})").model,
              ReflectanceModel::ggx);
}

TEST_F(GltfMaterial, IndexAndSpecularMakeTheFresnelTerm) {
    const char* water = R"({"pbrMetallicRoughness": {"metallicFactor": 0},
        "extensions": {"KHR_materials_ior": {"ior": 1.333}}})";
    EXPECT_NEAR(paint_of(water).f0.x, 0.020373, 1e-5);
    const char* tinted = R"({"pbrMetallicRoughness": {"metallicFactor": 0},
        "extensions": {"KHR_materials_specular":
            {"specularFactor": 0.5, "specularColorFactor": [1, 2, 50]}}})";
    const glm::dvec3 f0 = paint_of(tinted).f0;
    EXPECT_NEAR(f0.x, 0.02, 1e-12);
    EXPECT_NEAR(f0.y, 0.04, 1e-12);
    EXPECT_NEAR(f0.z, 0.5, 1e-12);  // at most all of the light
    const char* endless = R"({"pbrMetallicRoughness": {"metallicFactor": 0},
        "extensions": {"KHR_materials_ior": {"ior": 0}}})";
    EXPECT_EQ(paint_of(endless).f0, glm::dvec3(1.0));
}

TEST_F(GltfMaterial, AnisotropyWidensAlongTheGrain) {
    const auto brushed = [&](double rotation) {
        return paint_of(fmt::format(R"({{"pbrMetallicRoughness": {{"roughnessFactor": 0.4}},
            "extensions": {{"KHR_materials_anisotropy":
                {{"anisotropyStrength": 0.5, "anisotropyRotation": {}}}}}}})",
                                    rotation)
                            .c_str())
            .alpha;
    };
    // alpha = .16; along the grain mix(.16, 1, .5^2).
    EXPECT_NEAR(brushed(0.0).x, 0.37, 1e-12);
    EXPECT_NEAR(brushed(0.0).y, 0.16, 1e-12);
    EXPECT_NEAR(brushed(0.5 * std::numbers::pi).x, 0.16, 1e-12);
    EXPECT_NEAR(brushed(0.5 * std::numbers::pi).y, 0.37, 1e-12);
    EXPECT_NEAR(brushed(-std::numbers::pi).x, 0.37, 1e-12);
    EXPECT_TRUE(notes_.empty());
    EXPECT_NEAR(brushed(0.2).x, 0.37, 1e-12);
    ASSERT_EQ(notes_.size(), 1u);
    EXPECT_EQ(notes_[0],
              "material \"skin\": its grain is turned by 11 degrees; the nearest right angle is "
              "taken");
}

TEST_F(GltfMaterial, AnIridescentFilmInAirHasAirysReflectance) {
    const Material paint = paint_of(R"({"pbrMetallicRoughness":
        {"baseColorFactor": [0.7, 0.7, 0.7, 1], "roughnessFactor": 0.3},
        "extensions": {"KHR_materials_iridescence": {"iridescenceFactor": 1,
            "iridescenceIor": 1.8, "iridescenceThicknessMaximum": 1.5}}})");
    EXPECT_EQ(paint.model, ReflectanceModel::car_paint);
    EXPECT_EQ(paint.family, "pearl");
    EXPECT_EQ(paint.coat_f0, 0.0);
    EXPECT_EQ(paint.f0, glm::dvec3(0.0));
    EXPECT_EQ(paint.diffuse, glm::dvec3(0.0));
    EXPECT_NEAR(paint.flake_alpha, 0.09, 1e-12);
    EXPECT_EQ(paint.film_eta, 1.8);
    EXPECT_EQ(paint.film_nm, 1.5);
    EXPECT_TRUE(notes_.empty()) << notes_.front();
    EXPECT_NO_THROW(parameters_of_f64(paint));  // in range
    // A film much thinner than light reflects what its base does; the default one does not.
    const auto straight = [](const Material& of) {
        return f64::film_reflectance(f64::film_prepare(parameters_of_f64(of)), 4.0);
    };
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(straight(paint)[c], 0.7, 0.005);
    const Material usual = paint_of(R"({"pbrMetallicRoughness":
        {"baseColorFactor": [0.7, 0.7, 0.7, 1], "roughnessFactor": 0.3},
        "extensions": {"KHR_materials_iridescence": {"iridescenceFactor": 1}}})");
    EXPECT_EQ(usual.film_eta, 1.3);
    EXPECT_EQ(usual.film_nm, 400.0);
    EXPECT_GT(glm::distance(straight(usual), glm::dvec3(0.7)), 0.05);

    // Under varnish: the same colours straight on, and the coat's own gloss.
    const Material coated = paint_of(R"({"pbrMetallicRoughness":
        {"baseColorFactor": [0.7, 0.7, 0.7, 1], "roughnessFactor": 0.3},
        "extensions": {"KHR_materials_iridescence": {"iridescenceFactor": 1},
            "KHR_materials_clearcoat": {"clearcoatFactor": 1}}})");
    EXPECT_NEAR(coated.coat_f0, 0.04, 1e-12);
    EXPECT_NEAR(coated.film_eta, 1.95, 1e-12);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(straight(coated)[c], straight(usual)[c], 1e-9);
    EXPECT_TRUE(notes_.empty()) << notes_.front();
    // Without a factor there is no film.
    EXPECT_EQ(paint_of(R"({"extensions": {"KHR_materials_iridescence": {}}})").model,
              ReflectanceModel::ggx);
}

TEST_F(GltfMaterial, WhatAFilmCannotKeepIsSaid) {
    const Material plastic = paint_of(R"({"pbrMetallicRoughness":
        {"baseColorFactor": [0.1, 0.2, 0.3, 1], "metallicFactor": 0, "roughnessFactor": 0.4},
        "extensions": {"KHR_materials_anisotropy": {"anisotropyStrength": 0.5},
            "KHR_materials_iridescence": {"iridescenceFactor": 0.5, "iridescenceIor": 3,
                "iridescenceThicknessMinimum": 50, "iridescenceThicknessMaximum": 9000,
                "iridescenceThicknessTexture": {"index": 0}}}})");
    EXPECT_EQ(plastic.diffuse, glm::dvec3(0.1, 0.2, 0.3));
    EXPECT_NEAR(plastic.flake_f0.x, 0.04, 1e-12);
    EXPECT_EQ(plastic.alpha.x, plastic.alpha.y);
    EXPECT_NO_THROW(parameters_of_f64(plastic));
    EXPECT_EQ(notes_,
              (std::vector<std::string>{
                  "material \"skin\": KHR_materials_iridescence.iridescenceThicknessTexture, "
                  "KHR_materials_iridescence.iridescenceThicknessMinimum not read",
                  "material \"skin\": iridescenceFactor 0.5 is taken for 1",
                  "material \"skin\": under a thin film it is as rough along the grain as across",
                  "material \"skin\": a film's index of 3 is taken for 2.7",
                  "material \"skin\": a film's thickness in nanometres of 1e+04 is taken for "
                  "2000"}));
    EXPECT_TRUE(fails(R"({"extensions": {"KHR_materials_iridescence": {"iridescenceIor": 0.5}}})",
                      {"KHR_materials_iridescence.iridescenceIor", "0.5", "between 1 and 100"}));
    EXPECT_TRUE(fails(R"({"extensions": {"KHR_materials_iridescence":
                          {"iridescenceThicknessMaximum": -1}}})",
                      {"iridescenceThicknessMaximum", "-1"}));
    EXPECT_TRUE(fails(R"({"extensions": {"KHR_materials_iridescence": 1}})",
                      {"KHR_materials_iridescence", "an object"}));
}

TEST_F(GltfMaterial, WhatIsDroppedIsNamed) {
    paint_of(R"({"pbrMetallicRoughness": {"metallicFactor": 0}, "alphaMode": "BLEND",
        "emissiveFactor": [1, 0, 0], "normalTexture": {"index": 0},
        "extensions": {"KHR_materials_sheen": {"sheenRoughnessFactor": 1},
                       "KHR_materials_clearcoat":
                           {"clearcoatFactor": 1, "clearcoatNormalTexture": {"index": 0}}}})");
    EXPECT_EQ(notes_,
              (std::vector<std::string>{
                  "material \"skin\": emissiveFactor, alphaMode BLEND, "
                  "KHR_materials_clearcoat.clearcoatNormalTexture, KHR_materials_sheen not read",
                  "material \"skin\": normalTexture: a texture without a picture"}));
    // Which places are metal stands in a picture: no paint is better than a wrong one.
    EXPECT_FALSE(part_of(R"({"pbrMetallicRoughness":
        {"metallicFactor": 1, "metallicRoughnessTexture": {"index": 0}}})")
                     .paint);
    ASSERT_EQ(notes_.size(), 1u);
    EXPECT_NE(notes_[0].find("shown without gloss"), std::string::npos);
}

TEST_F(GltfMaterial, BadOnesSayWhy) {
    EXPECT_TRUE(
        fails(R"({"pbrMetallicRoughness": {"metallicFactor": 2}})",
              {"materials[0].pbrMetallicRoughness.metallicFactor", "2", "between 0 and 1"}));
    EXPECT_TRUE(fails(R"({"pbrMetallicRoughness": {"roughnessFactor": "rough"}})",
                      {"roughnessFactor", "\"rough\"", "a number"}));
    EXPECT_TRUE(
        fails(R"({"pbrMetallicRoughness": {"roughnessFactor": -0.1}})", {"roughnessFactor"}));
    EXPECT_TRUE(fails(R"({"extensions": {"KHR_materials_clearcoat": {"clearcoatFactor": 1e9}}})",
                      {"extensions.KHR_materials_clearcoat.clearcoatFactor", "found 1000000000"}));
    EXPECT_TRUE(fails(R"({"extensions": {"KHR_materials_clearcoat": [1]}})",
                      {"KHR_materials_clearcoat", "an object"}));
    EXPECT_TRUE(fails(R"({"extensions": [1]})", {"materials[0].extensions", "an object"}));
    EXPECT_TRUE(fails(R"({"extensions": {"KHR_materials_ior": {"ior": 0.5}}})",
                      {"KHR_materials_ior.ior", "0.5", "0, or 1 and more"}));
    EXPECT_TRUE(fails(R"({"extensions": {"KHR_materials_ior": {"ior": null}}})", {"ior", "null"}));
    EXPECT_TRUE(
        fails(R"({"extensions": {"KHR_materials_specular": {"specularColorFactor": [1, 1]}}})",
              {"specularColorFactor", "2 elements"}));
    EXPECT_TRUE(
        fails(R"({"extensions": {"KHR_materials_specular": {"specularColorFactor": [-1, 1, 1]}}})",
              {"specularColorFactor[0]", "-1"}));
    EXPECT_TRUE(fails(R"({"extensions": {"KHR_materials_anisotropy": {"anisotropyStrength": 3}}})",
                      {"anisotropyStrength", "3"}));
    EXPECT_TRUE(fails(R"({"alphaMode": 7})", {"alphaMode", "a text"}));
    EXPECT_TRUE(fails(R"({"emissiveFactor": [1]})", {"emissiveFactor", "1 elements"}));
}

TEST_F(GltfMaterial, ALookThatDoesNotPaintAPartLeavesItsOwn) {
    GltfBuilder plate = make_plate();
    plate.json["materials"] = Json::parse(R"([{"name": "trim", "pbrMetallicRoughness":
        {"baseColorFactor": [0.9, 0.9, 0.9, 1], "roughnessFactor": 0.3}}])");
    plate.primitive()["material"] = 0;
    auto product = std::make_shared<Product>(load_product(folder_.write("plate.glb", plate.glb())));
    const Scene scene = make_scene(product, Look(), {0.0, 0.0, 1000.0});
    ASSERT_EQ(scene.part_materials.size(), 1u);
    EXPECT_EQ(scene.part_materials[0].model, ReflectanceModel::ggx);
    EXPECT_EQ(scene.part_materials[0].name, "trim");
    EXPECT_NEAR(scene.part_materials[0].alpha.x, 0.09, 1e-12);
}

}  // namespace
}  // namespace livery
