// KHR_materials_variants: what a product's file calls its looks.

#include <gtest/gtest.h>

#include "mesh/gltf_builder.h"
#include "mesh/mesh.h"
#include "scene/library.h"
#include "scene/look.h"
#include "scene/scene.h"
#include "support/file_error.h"
#include "support/temporary_folder.h"

namespace livery {
namespace {

/// A plate in grey that is red by day and blue by night.
GltfBuilder plate_of_day_and_night() {
    GltfBuilder plate = make_plate();
    const auto coloured = [](const char* name, double r, double g, double b) {
        return Json{{"name", name},
                    {"pbrMetallicRoughness",
                     {{"baseColorFactor", {r, g, b, 1.0}}, {"metallicFactor", 0.0}}}};
    };
    plate.json["materials"] = {coloured("grey", 0.5, 0.5, 0.5),
                               coloured("red", 0.8, 0.1, 0.1),
                               coloured("blue", 0.1, 0.1, 0.8)};
    plate.json["extensionsUsed"] = {"KHR_materials_variants"};
    plate.json["extensions"]["KHR_materials_variants"]["variants"] = {{{"name", "day"}},
                                                                      {{"name", "night"}}};
    plate.primitive()["material"] = 0;
    plate.primitive()["extensions"]["KHR_materials_variants"]["mappings"] = {
        {{"material", 1}, {"variants", {0}}}, {{"material", 2}, {"variants", {1}}}};
    return plate;
}

class GltfVariant : public ::testing::Test {
  protected:
    Mesh load(const GltfBuilder& plate) {
        notes_.clear();
        return load_mesh(folder_.write("mesh.glb", plate.glb()), &notes_);
    }
    TemporaryFolder folder_;
    std::vector<std::string> notes_;
};

TEST_F(GltfVariant, EachSaysWhatPartsWearInIt) {
    const Mesh mesh = load(plate_of_day_and_night());
    EXPECT_TRUE(notes_.empty());
    ASSERT_EQ(mesh.variants.size(), 2u);
    EXPECT_EQ(mesh.variants[1].name, "night");
    const Part& night = mesh.variants[1].parts.at(0);
    EXPECT_EQ(night.name, "plate");
    EXPECT_EQ(night.material_name, "blue");
    EXPECT_EQ(night.paint->diffuse, glm::dvec3(0.1, 0.1, 0.8));
    EXPECT_EQ(mesh.parts.at(0).material_name, "grey");
}

TEST_F(GltfVariant, PrimitivesThatChangeOtherwiseArePartsOfTheirOwn) {
    GltfBuilder plate = plate_of_day_and_night();
    Json still = plate.primitive();
    still.erase("extensions");
    still["attributes"]["POSITION"] =
        plate.add(std::vector<float>{2, 0, 0, 3, 0, 0, 3, 1, 0, 2, 1, 0}, "VEC3", 5126, 4);
    plate.json["meshes"][0]["primitives"].push_back(still);
    const Mesh mesh = load(plate);
    ASSERT_EQ(mesh.parts.size(), 2u);
    EXPECT_EQ(mesh.parts[1].name, "plate/grey-2");
    EXPECT_TRUE(mesh.variants[0].parts.contains(0));
    EXPECT_FALSE(mesh.variants[0].parts.contains(1));
}

TEST_F(GltfVariant, ALookWearsOneUnderItsOwnPaints) {
    auto product = std::make_shared<Product>();
    product->mesh = load(plate_of_day_and_night());
    Look look;
    look.variant = "night";
    const auto diffuse = [&] {
        return make_scene(product, look, glm::dvec3(0, 0, 1000)).part_materials.at(0).diffuse;
    };
    EXPECT_EQ(diffuse(), glm::dvec3(0.1, 0.1, 0.8));
    look.variant = "";
    EXPECT_EQ(diffuse(), glm::dvec3(0.5));
    look.variant = "noon";
    EXPECT_TRUE(fails_with(diffuse, {"variant: found no variant \"noon\"", "day", "night"}));
    look.variant = "day";
    look.parts["plate"] = "solid white";
    EXPECT_NE(diffuse(), glm::dvec3(0.8, 0.1, 0.1));
}

TEST_F(GltfVariant, LookFilesKeepIt) {
    Look look;
    look.name = "evening";
    look.variant = "night";
    write_look_file(folder_ / "look.json", look);
    EXPECT_EQ(read_look_file(folder_ / "look.json").variant, "night");
}

TEST_F(GltfVariant, TheFilesOwnLooksAreFoundByName) {
    const Mesh mesh = load(plate_of_day_and_night());
    const auto looks = own_looks(mesh);
    ASSERT_EQ(looks.size(), 3u);
    EXPECT_EQ(looks[0].name, "as it comes");
    EXPECT_TRUE(looks[0].variant.empty());
    EXPECT_EQ(looks[2].variant, "night");
    EXPECT_TRUE(looks[2].parts.empty());
    EXPECT_FALSE(looks[2].lights.empty() && looks[2].environment.file.empty());
    EXPECT_EQ(find_look_for("night", mesh).variant, "night");
    EXPECT_TRUE(fails_with([&] { find_look_for("noon", mesh); }, {"noon"}));
    EXPECT_TRUE(own_looks(load(make_plate())).empty());
}

TEST_F(GltfVariant, BadOnesAreNamed) {
    GltfBuilder plate = plate_of_day_and_night();
    Json& mappings = plate.primitive()["extensions"]["KHR_materials_variants"]["mappings"];
    const std::string field =
        "meshes[0].primitives[0].extensions.KHR_materials_variants.mappings[1].";
    mappings[1]["variants"] = {2};
    EXPECT_TRUE(fails_with([&] { load(plate); },
                           {field + "variants[0]: found 2, expected a whole number between 0"}));
    mappings[1]["variants"] = {0};
    EXPECT_TRUE(
        fails_with([&] { load(plate); }, {field + "variants[0]: found the variant 0 a second"}));
    mappings[1] = {{"material", 9}, {"variants", {1}}};
    EXPECT_TRUE(fails_with([&] { load(plate); }, {field + "material: found 9"}));
    plate = plate_of_day_and_night();
    plate.json.erase("extensions");
    EXPECT_TRUE(
        fails_with([&] { load(plate); }, {"mappings[0].variants[0]: found 0, expected no index"}));
}

TEST_F(GltfVariant, MoreThanAnybodyChoosesFromAreRefusedAtOnce) {
    GltfBuilder plate = plate_of_day_and_night();
    Json& variants = plate.json["extensions"]["KHR_materials_variants"]["variants"];
    for (int k = 0; k < 200'000; ++k) variants.push_back({{"name", std::to_string(k)}});
    EXPECT_TRUE(fails_with([&] { load(plate); }, {"200002 variants", "at most 1024"}));
}

}  // namespace
}  // namespace livery
