#include "scene/product.h"

#include <functional>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/image_io.h"
#include "mesh/gltf_builder.h"
#include "scene/scene.h"
#include "support/file_error.h"
#include "support/temporary_folder.h"

namespace livery {
namespace {

class ProductFile : public testing::Test {
  protected:
    ProductFile() { folder_.write("plate.glb", make_plate().glb()); }
    std::filesystem::path write(const Json& json) {
        return folder_.write("product.json", json.dump());
    }
    TemporaryFolder folder_;
};

Json some_product() {
    return Json::parse(R"({"format_version": 1, "name": "Plate", "mesh": "plate.glb",
        "product_scale": 25, "parts": ["plate"],
        "pose": {"rotation": [0, -1, 0, 1, 0, 0, 0, 0, 1], "translation_mm": [5, 6, 7]}})");
}

TEST_F(ProductFile, NamesItsMeshItsScaleAndItsPose) {
    const Product plate = load_product(write(some_product()));
    EXPECT_EQ(plate.name, "Plate");
    EXPECT_EQ(plate.product_scale, 25.0);
    // (1000, 0, 0) turns to (0, 1000, 0) and moves.
    EXPECT_LT(glm::distance(plate.mesh.positions_mm[1], glm::vec3(5, 1006, 7)), 1e-3f);
    EXPECT_LT(glm::distance(glm::vec3(plate.mesh.tangents[0]), glm::vec3(0, 1, 0)), 1e-6f);
    EXPECT_EQ(part_index(plate, "plate"), 0);
}

TEST_F(ProductFile, AMeshAloneIsAProductToo) {
    const Product plate = load_product(folder_ / "plate.glb");
    EXPECT_EQ(plate.name, "plate");
    EXPECT_EQ(plate.product_scale, 1.0);
}

TEST_F(ProductFile, AnUnknownPartIsAnsweredWithTheKnownOnes) {
    const Product plate = load_product(folder_ / "plate.glb");
    try {
        part_index(plate, "door");
        FAIL() << "no error";
    } catch (const std::invalid_argument& error) {
        EXPECT_STREQ(error.what(), "no part \"door\"; there are plate");
    }
}

struct Broken {
    const char* what;
    std::function<void(Json&)> damage;
    const char* message;
};

const Broken kBroken[] = {
    {"no version", [](Json& p) { p.erase("format_version"); }, "format_version: found nothing"},
    {"newer version", [](Json& p) { p["format_version"] = 9; }, "found 9 (written by a newer"},
    {"no mesh", [](Json& p) { p.erase("mesh"); }, "product.json: mesh: found nothing"},
    {"mesh of no name", [](Json& p) { p["mesh"] = ""; }, "mesh: found an empty name"},
    {"missing mesh", [](Json& p) { p["mesh"] = "gone.glb"; }, "gone.glb: found no such file"},
    {"mesh that is none", [](Json& p) { p["mesh"] = "product.json"; }, "no \"glTF\" at the start"},
    {"scale of zero", [](Json& p) { p["product_scale"] = 0; }, "product_scale: found 0"},
    {"scale as a text", [](Json& p) { p["product_scale"] = "25"; }, "product_scale: found \"25\""},
    {"unknown part",
     [](Json& p) { p["parts"] = {"door"}; },
     "parts[0]: found \"door\", expected a part"},
    {"misspelt field", [](Json& p) { p["scale"] = 25; }, "the unknown field \"scale\""},
    {"pose in metres",
     [](Json& p) { p["pose"]["translation_m"] = 1; },
     "pose: found the unknown field"},
    {"pose without rotation", [](Json& p) { p["pose"].erase("rotation"); }, "pose.rotation: found"},
    {"mirrored pose",
     [](Json& p) {
         p["pose"]["rotation"] = {-1, 0, 0, 0, 1, 0, 0, 0, 1};
     },
     "pose.rotation: found a mirror"},
};

TEST_F(ProductFile, EachMistakeIsNamed) {
    for (const auto& broken : kBroken) {
        Json json = some_product();
        broken.damage(json);
        const auto file = write(json);
        EXPECT_TRUE(fails_with([&] { load_product(file); }, {broken.message})) << broken.what;
    }
    EXPECT_TRUE(fails_with([&] { load_product(folder_ / "gone.json"); }, {"no such file"}));
    EXPECT_TRUE(fails_with([&] { load_product(folder_.write("a.json", "")); }, {"empty file"}));
    EXPECT_TRUE(fails_with([&] { load_product(folder_.write("a.json", "{\"mesh\": ")); },
                           {"a.json: line 1, column", "not JSON"}));
}

class SceneOfALook : public ProductFile {
  protected:
    SceneOfALook() : plate_(std::make_shared<Product>(load_product(folder_ / "plate.glb"))) {
        look_.file = folder_ / "look.json";
        folder_.write("grey.json", R"({"format_version": 1, "name": "my grey", "model": "lambert",
                                       "parameters": {"diffuse": [0.3, 0.3, 0.3]}})");
    }
    std::shared_ptr<Product> plate_;
    Look look_;
};

TEST_F(SceneOfALook, APartWithoutAPaintKeepsItsOwnColour) {
    plate_->mesh.parts[0].base_colour_rec709 = {0.1, 0.2, 0.3};
    look_.lights.resize(1);
    look_.exposure_ev = 2.0;
    const Scene scene = make_scene(plate_, look_, {1, 2, 3});
    ASSERT_EQ(scene.part_materials.size(), 1u);
    EXPECT_EQ(scene.part_materials[0].model, ReflectanceModel::lambert);
    EXPECT_EQ(scene.part_materials[0].diffuse, glm::dvec3(0.1, 0.2, 0.3));
    EXPECT_EQ(scene.lights.size(), 1u);
    EXPECT_EQ(scene.exposure_ev, 2.0);
    EXPECT_EQ(scene.eye_in_world_mm, glm::dvec3(1, 2, 3));
    EXPECT_EQ(scene.environment, nullptr);
}

TEST_F(SceneOfALook, PaintsComeByFileBesideTheLookAndForTheRest) {
    look_.parts = {{"*", "grey.json"}};
    EXPECT_EQ(make_scene(plate_, look_, {}).part_materials[0].name, "my grey");
    look_.parts = {{"*", "no such paint"}, {"plate", "grey.json"}};
    EXPECT_EQ(make_scene(plate_, look_, {}).part_materials[0].name, "my grey");
}

TEST_F(SceneOfALook, TheSameEnvironmentIsSharedAndAnotherIsRead) {
    write_exr(folder_ / "sky.exr", ImageF(4, 2, 3, 0.5f));
    look_.environment.file = "sky.exr";
    const auto first = make_scene(plate_, look_, {}).environment;
    EXPECT_EQ(make_scene(plate_, look_, {}, first).environment, first);
    look_.environment.rotation_rad = 0.5;
    const auto turned = make_scene(plate_, look_, {}, first).environment;
    EXPECT_NE(turned, first);
    EXPECT_EQ(turned->rotation_rad, 0.5);
    look_.environment.file.clear();
    EXPECT_EQ(make_scene(plate_, look_, {}, first).environment, nullptr);
}

TEST_F(SceneOfALook, UnknownPartsPaintsAndMapsAreRefused) {
    look_.parts = {{"door", "grey.json"}};
    EXPECT_TRUE(fails_with(
        [&] { make_scene(plate_, look_, {}); },
        {"look.json: parts.door: found no such part in plate, expected one of *, plate"}));
    look_.parts = {{"plate", "no such paint"}};
    EXPECT_TRUE(fails_with([&] { make_scene(plate_, look_, {}); }, {"no such paint"}));
    look_.parts.clear();
    look_.environment.file = "gone.hdr";
    EXPECT_TRUE(fails_with([&] { make_scene(plate_, look_, {}); }, {"gone.hdr"}));
    EXPECT_THROW(make_scene(nullptr, look_, {}), std::invalid_argument);
}

TEST_F(SceneOfALook, TheDefaultEyeSeesTheWholeProduct) {
    const glm::dvec3 eye = default_eye_mm(*plate_);
    const View view = look_at(eye, {500, 500, 0}, 30.0 * 3.14159265 / 180.0, 800, 800);
    for (const auto& position : plate_->mesh.positions_mm) {
        const auto pixel = project(view, position);
        ASSERT_TRUE(pixel);
        EXPECT_TRUE(pixel->x > 0 && pixel->x < 800 && pixel->y > 0 && pixel->y < 800);
    }
}

}  // namespace
}  // namespace livery
