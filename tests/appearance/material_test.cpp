// Paint files: what is read is what was written, and every mistake is named.
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

#include "appearance/bsdf.h"
#include "appearance/material_library.h"
#include "appearance/parameter_table.h"
#include "core/colour.h"
#include "core/paths.h"
#include "support/file_error.h"
#include "support/temporary_folder.h"

namespace livery {
namespace {

Material full_material() {
    Material material;
    material.name = "test paint";
    material.family = "metallic";
    material.model = ReflectanceModel::clearcoat;
    // Signed: a green outside Rec.709 but inside the working space
    material.diffuse = {-0.02, 0.4, 0.1};
    material.f0 = {0.5, 0.4, 0.3};
    material.alpha = {0.2, 0.35};
    material.coat_alpha = 0.03;
    material.coat_f0 = 0.05;
    material.coat_transmittance = {0.9, 0.8, 0.7};
    material.provenance = "made up for a test, \"quoted\"";
    return material;
}

TEST(MaterialFile, ComesBackAsItWasWritten) {
    const TemporaryFolder folder;
    const auto file = folder / "paint.json";
    for (const auto model :
         {ReflectanceModel::lambert, ReflectanceModel::ggx, ReflectanceModel::clearcoat}) {
        Material material = full_material();
        material.model = model;
        write_material_file(file, material);
        const Material back = read_material_file(file);
        EXPECT_EQ(back.name, material.name);
        EXPECT_EQ(back.family, material.family);
        EXPECT_EQ(back.model, model);
        EXPECT_EQ(back.diffuse, material.diffuse);
        EXPECT_EQ(back.provenance, material.provenance);
        EXPECT_EQ(back.file, file);
        if (model == ReflectanceModel::lambert) continue;
        EXPECT_EQ(back.f0, material.f0);
        EXPECT_EQ(back.alpha, material.alpha);
        if (model == ReflectanceModel::ggx) continue;
        EXPECT_EQ(back.coat_alpha, material.coat_alpha);
        EXPECT_EQ(back.coat_f0, material.coat_f0);
        EXPECT_EQ(back.coat_transmittance, material.coat_transmittance);
    }
}

Material material_without_glints(Material material) {
    material.glint_density_per_mm2 = 0.0;
    return material;
}

TEST(MaterialFile, MayLeaveOutWhatAPaintNeedNotHave) {
    const TemporaryFolder folder;
    const auto file = folder / "paint.json";
    Material material = full_material();
    material.model = ReflectanceModel::car_paint;
    write_material_file(file, material);
    EXPECT_EQ(read_text_file(file).find("film"), std::string::npos);
    EXPECT_EQ(read_text_file(file).find("glint"), std::string::npos);
    EXPECT_FALSE(has_glints(read_material_file(file)));
    EXPECT_EQ(read_material_file(file).film_nm, 0.0);
    material.film_nm = 240.0;
    material.film_eta = 1.9;
    material.glint_density_per_mm2 = 3200.0;
    material.glint_scale = 12.0;
    write_material_file(file, material);
    const Material back = read_material_file(file);
    EXPECT_EQ(back.film_nm, 240.0);
    EXPECT_EQ(back.film_eta, 1.9);
    EXPECT_EQ(back.glint_density_per_mm2, 3200.0);
    EXPECT_EQ(glint_scale_text(back), "exaggerated 12 times");
    EXPECT_TRUE(has_glints(back));
    EXPECT_FALSE(same_reflectance(back, material_without_glints(back)));
}

TEST(MaterialFile, RefusesToWriteWhatItWouldNotRead) {
    const TemporaryFolder folder;
    Material material = full_material();
    material.alpha.x = 0.0;
    EXPECT_THROW(write_material_file(folder / "paint.json", material), std::invalid_argument);
}

struct BadFile {
    const char* what;
    const char* text;
    std::initializer_list<std::string_view> message;
};

const BadFile kBadFiles[] = {
    {"empty", "", {"paint.json"}},
    {"truncated", R"({"format_version": 1, "name": "a", "mod)", {"paint.json", "line 1"}},
    {"no object", "[1, 2]", {"paint.json", "object"}},
    {"no version",
     R"({"name": "a", "model": "lambert", "parameters": {"diffuse": [0, 0, 0]}})",
     {"format_version"}},
    {"newer version",
     R"({"format_version": 2, "name": "a", "model": "lambert", "parameters": {}})",
     {"format_version", "2", "1"}},
    {"no name",
     R"({"format_version": 1, "model": "lambert", "parameters": {"diffuse": [0, 0, 0]}})",
     {"name", "nothing"}},
    {"empty name",
     R"({"format_version": 1, "name": "", "model": "lambert", "parameters": {}})",
     {"name", "empty"}},
    {"unknown field",
     R"({"format_version": 1, "name": "a", "modell": "lambert", "parameters": {}})",
     {"modell"}},
    {"unknown model",
     R"({"format_version": 1, "name": "a", "model": "velvet", "parameters": {}})",
     {"model", "'velvet'", "lambert, eon, "}},
    {"unknown parameter",
     R"({"format_version": 1, "name": "a", "model": "ggx",
         "parameters": {"diffuse": [0, 0, 0], "f0": [0, 0, 0], "alpha": 0.1, "roughness": 0.3}})",
     {"parameters", "'roughness'", "diffuse, f0, alpha"}},
    {"another model's parameter",
     R"({"format_version": 1, "name": "a", "model": "lambert",
         "parameters": {"diffuse": [0, 0, 0], "coat_f0": 0.04}})",
     {"'coat_f0'", "the parameters of lambert: diffuse"}},
    {"missing parameter",
     R"({"format_version": 1, "name": "a", "model": "ggx",
         "parameters": {"diffuse": [0, 0, 0], "f0": [0, 0, 0]}})",
     {"parameters.alpha", "nothing"}},
    {"two components",
     R"({"format_version": 1, "name": "a", "model": "lambert",
         "parameters": {"diffuse": [0, 0]}})",
     {"parameters.diffuse", "2"}},
    {"not a number",
     R"({"format_version": 1, "name": "a", "model": "lambert",
         "parameters": {"diffuse": [0, NaN, 0]}})",
     {"paint.json", "line 2"}},
    {"a number too large",
     R"({"format_version": 1, "name": "a", "model": "lambert",
         "parameters": {"diffuse": [0, 1e400, 0]}})",
     {"paint.json"}},
    {"a text",
     R"({"format_version": 1, "name": "a", "model": "ggx",
         "parameters": {"diffuse": [0, 0, 0], "f0": [0, 0, 0], "alpha": "shiny"}})",
     {"parameters.alpha", "shiny"}},
    {"alpha too small",
     R"({"format_version": 1, "name": "a", "model": "ggx",
         "parameters": {"diffuse": [0, 0, 0], "f0": [0, 0, 0], "alpha": 0}})",
     {"parameters.alpha", "0", "between 0.0001 and 1"}},
    {"three alphas",
     R"({"format_version": 1, "name": "a", "model": "ggx",
         "parameters": {"diffuse": [0, 0, 0], "f0": [0, 0, 0], "alpha": [0.1, 0.1, 0.1]}})",
     {"parameters.alpha", "one number or two"}},
    {"a film too thick",
     R"({"format_version": 1, "name": "a", "model": "car-paint",
         "parameters": {"diffuse": [0, 0, 0], "f0": [0, 0, 0], "alpha": 0.1, "flake_f0": [0, 0, 0],
                        "flake_alpha": 0.1, "film_nm": 2001, "coat_alpha": 0.1, "coat_f0": 0,
                        "coat_transmittance": [1, 1, 1]}})",
     {"parameters.film_nm", "2001", "between 0 and 2000"}},
    {"flakes smaller than they are",
     R"({"format_version": 1, "name": "a", "model": "car-paint",
         "parameters": {"diffuse": [0, 0, 0], "f0": [0, 0, 0], "alpha": 0.1, "flake_f0": [0, 0, 0],
                        "flake_alpha": 0.1, "glint_density_per_mm2": 10, "glint_scale": 0.5, "coat_alpha": 0.1, "coat_f0": 0,
                        "coat_transmittance": [1, 1, 1]}})",
     {"parameters.glint_scale", "0.5", "between 1 and 1000"}},
    {"fewer flakes than none",
     R"({"format_version": 1, "name": "a", "model": "car-paint",
         "parameters": {"diffuse": [0, 0, 0], "f0": [0, 0, 0], "alpha": 0.1, "flake_f0": [0, 0, 0],
                        "flake_alpha": 0.1, "glint_density_per_mm2": -1, "coat_alpha": 0.1, "coat_f0": 0,
                        "coat_transmittance": [1, 1, 1]}})",
     {"parameters.glint_density_per_mm2", "-1", "between 0 and"}},
    {"second alpha too large",
     R"({"format_version": 1, "name": "a", "model": "ggx",
         "parameters": {"diffuse": [0, 0, 0], "f0": [0, 0, 0], "alpha": [0.1, 1.5]}})",
     {"parameters.alpha[1]", "1.5"}},
    {"brighter than white",
     R"({"format_version": 1, "name": "a", "model": "lambert",
         "parameters": {"diffuse": [1.2, 1.2, 1.2]}})",
     {"parameters", "diffuse (1.2, 1.2, 1.2)", "outside [0, 1]"}},
    {"too saturated",
     R"({"format_version": 1, "name": "a", "model": "lambert",
         "parameters": {"diffuse": [-0.5, 0.4, 0.1]}})",
     {"parameters", "diffuse (-0.5, 0.4, 0.1)", "outside [0, 1]"}},
};

TEST(MaterialFile, NamesEveryMistake) {
    const TemporaryFolder folder;
    for (const BadFile& bad : kBadFiles) {
        const auto file = folder.write("paint.json", bad.text);
        EXPECT_TRUE(fails_with([&] { read_material_file(file); }, bad.message)) << bad.what;
    }
    EXPECT_TRUE(fails_with([&] { read_material_file(folder / "no.json"); }, {"no.json"}));
    EXPECT_TRUE(fails_with([&] { read_material_file(folder.path()); }, {"livery test"}));
    const auto huge = folder.write("huge.json", std::string(2u << 20u, ' '));
    EXPECT_TRUE(fails_with([&] { read_material_file(huge); }, {"huge.json"}));
}

TEST(Library, EveryShippedPaintIsReadAndFoundByItsName) {
    const auto library = read_paint_folder(shipped_path("materials"));
    EXPECT_GE(library.size(), 12u);
    for (const Material& material : library) {
        EXPECT_EQ(find_material(material.name).file, material.file);
        EXPECT_EQ(find_material(material.file.string()).name, material.name);
        EXPECT_FALSE(material.provenance.empty()) << material.name;
        EXPECT_FALSE(material.family.empty()) << material.name;
        EXPECT_NO_THROW(parameters_of(material)) << material.name;
    }
    EXPECT_EQ(find_material("Solid-Red").name, "solid red");
}

TEST(Library, OffersTheNearestNames) {
    EXPECT_TRUE(fails_with([] { find_material("solid rad"); },
                           {"no paint named 'solid rad'", "nearest: 'solid red'"}));
    EXPECT_TRUE(fails_with([] { find_material("no-such-file.json"); }, {"no-such-file.json"}));
}

TEST(Library, RefusesTwoPaintsOfOneNameAndAMissingFolder) {
    const TemporaryFolder folder;
    write_material_file(folder / "a.json", full_material());
    write_material_file(folder / "b.json", full_material());
    EXPECT_TRUE(fails_with([&] { read_paint_folder(folder.path()); },
                           {"b.json", "'test paint'", "a.json"}));
    EXPECT_TRUE(fails_with([&] { read_paint_folder(folder / "none"); }, {"none"}));
}

TEST(Parameters, AreInTheWorkingSpace) {
    const Material material = full_material();
    const f64::BsdfParameters p = parameters_of_f64(material);
    const glm::dvec3 expected = working_from_rec709() * material.diffuse;
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(p.diffuse[c], expected[c], 1e-15);
    EXPECT_GT(p.diffuse.x, 0.0);
    EXPECT_EQ(parameters_of(material).alpha_y, 0.35f);
    Material bad = material;
    bad.coat_f0 = std::nan("");
    try {
        parameters_of(bad);
        FAIL();
    } catch (const std::invalid_argument& error) {
        EXPECT_NE(std::string(error.what()).find("'test paint': coat_f0 is nan"), std::string::npos)
            << error.what();
    }
}

}  // namespace
}  // namespace livery
