#include "scene/product.h"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <gtest/gtest.h>

#include "core/image_io.h"
#include "mesh/gltf_builder.h"
#include "scene/broken.h"
#include "scene/scene.h"
#include "support/file_error.h"
#include "support/temporary_folder.h"

namespace livery {
namespace {

class ProductOfAFile : public ::testing::Test {
  protected:
    ProductOfAFile() { folder_.write("plate.glb", make_plate().glb()); }
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

TEST_F(ProductOfAFile, NamesItsMeshItsScaleAndItsPose) {
    const Product plate = load_product(write(some_product()));
    EXPECT_EQ(plate.name, "Plate");
    EXPECT_EQ(plate.product_scale, 25.0);
    // (1000, 0, 0) turns to (0, 1000, 0) and moves.
    EXPECT_LT(glm::distance(plate.mesh.positions_mm[1], glm::vec3(5, 1006, 7)), 1e-3f);
    EXPECT_LT(glm::distance(glm::vec3(plate.mesh.tangents[0]), glm::vec3(0, 1, 0)), 1e-6f);
    EXPECT_EQ(part_index(plate, "plate"), 0);
}

TEST_F(ProductOfAFile, AMeshAloneIsAProductToo) {
    const Product plate = load_product(folder_ / "plate.glb");
    EXPECT_EQ(plate.name, "plate");
    EXPECT_EQ(plate.product_scale, 1.0);
}

TEST_F(ProductOfAFile, AnUnknownPartIsAnsweredWithTheKnownOnes) {
    const Product plate = load_product(folder_ / "plate.glb");
    try {
        part_index(plate, "door");
        FAIL() << "no error";
    } catch (const std::invalid_argument& error) {
        EXPECT_STREQ(error.what(), "no part \"door\"; there are plate");
    }
}

const Broken kBrokenProducts[] = {
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
    {"mesh scale of zero", [](Json& p) { p["mesh_scale"] = 0; }, "mesh_scale: found 0"},
    {"name for a part that is not there",
     [](Json& p) {
         p["part_names"] = {{"door", "body"}};
     },
     "part_names: found \"door\", expected a part of the mesh: plate"},
    {"part without a name",
     [](Json& p) {
         p["part_names"] = {{"plate", ""}};
     },
     "part_names.plate: found an empty name"},
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

TEST_F(ProductOfAFile, ComesBackAsItWasWritten) {
    ProductFile said;
    said.name = "Car \"A\"";
    said.mesh = folder_ / "plate.glb";
    said.unit = LengthUnit::in;
    said.mesh_scale = 0.04;
    said.product_scale = 25.0;
    said.world_from_mesh =
        standing_pose({{-1, 2, 3}, {5, 6, 9}}, upright_rotation(UpAxis::minus_z, 1));
    said.part_names = {{"plate", "body"}};
    said.parts = {"body"};
    said.front = "-z";
    const auto file = folder_ / "own.product.json";
    const ProductFile read = parse_product_file(text_of(said, file), file);
    EXPECT_EQ(read.name, said.name);
    EXPECT_EQ(read.mesh, said.mesh);
    EXPECT_EQ(read.unit, said.unit);
    EXPECT_EQ(read.mesh_scale, said.mesh_scale);
    EXPECT_EQ(read.product_scale, said.product_scale);
    ASSERT_TRUE(read.world_from_mesh);
    EXPECT_EQ(read.world_from_mesh->rotation, said.world_from_mesh->rotation);
    EXPECT_EQ(read.world_from_mesh->translation, said.world_from_mesh->translation);
    EXPECT_EQ(read.part_names, said.part_names);
    EXPECT_EQ(read.parts, said.parts);
    EXPECT_EQ(read.front, said.front);
    // Beside the file it may move along with it; elsewhere it is named whole.
    EXPECT_EQ(Json::parse(text_of(said, file))["mesh"], "plate.glb");
    EXPECT_EQ(Json::parse(text_of(said, "/elsewhere/own.json"))["mesh"], said.mesh.string());
}

TEST_F(ProductOfAFile, ResizesBeforeItMovesAndNamesParts) {
    Json json = some_product();
    json["mesh_scale"] = 0.5;
    json["part_names"] = {{"plate", "body"}};
    json["parts"] = {"body"};
    const Product plate = load_product(write(json));
    EXPECT_EQ(part_index(plate, "body"), 0);
    EXPECT_LT(glm::distance(plate.mesh.positions_mm[1], glm::vec3(5, 506, 7)), 1e-3f);
    EXPECT_NEAR(glm::length(plate.mesh.normals[0]), 1.0f, 1e-6f);
}

TEST(Upright, EachAxisBecomesUpWithoutAMirror) {
    const glm::dvec3 ups[] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    for (int k = 0; k < 6; ++k) {
        for (int turns = -1; turns < 4; ++turns) {
            const glm::dmat3 rotation = upright_rotation(static_cast<UpAxis>(k), turns);
            EXPECT_EQ(rotation * ups[k], glm::dvec3(0, 1, 0)) << k;
            EXPECT_EQ(glm::determinant(rotation), 1.0) << k;
        }
    }
    // Counter-clockwise from above: what points at the viewer (+z) goes to the right.
    EXPECT_EQ(upright_rotation(UpAxis::plus_y, 1) * glm::dvec3(0, 0, 1), glm::dvec3(1, 0, 0));
    EXPECT_EQ(upright_rotation(UpAxis::plus_y, 4), glm::dmat3(1.0));
}

TEST(Upright, AProductStandsOnTheGroundOverTheOrigin) {
    const Rigid3 pose =
        standing_pose({{10, 20, 30}, {14, 22, 36}}, upright_rotation(UpAxis::plus_z, 0));
    EXPECT_EQ(pose * glm::dvec3(10, 20, 30), glm::dvec3(-2, 0, 1));
    EXPECT_EQ(pose * glm::dvec3(14, 22, 36), glm::dvec3(2, 6, -1));
}

TEST_F(ProductOfAFile, TwoPartsOfOneNameAreRefused) {
    Mesh mesh = make_sphere({}, 10.0, 4, "door");
    append(mesh, make_sphere({50, 0, 0}, 10.0, 4, "hood"), "");
    ProductFile said;
    said.part_names = {{"door", "body"}, {"hood", "body"}};
    EXPECT_TRUE(fails_with([&] { apply(said, "a.json", mesh); },
                           {"part_names: found two parts called \"body\"", "door, hood"}));
    // Names may change places.
    mesh.parts[0].name = "door";
    mesh.parts[1].name = "hood";
    said.part_names = {{"door", "hood"}, {"hood", "door"}};
    apply(said, "a.json", mesh);
    EXPECT_EQ(mesh.parts[0].name, "hood");
}

TEST_F(ProductOfAFile, EachMistakeIsNamed) {
    for (const auto& broken : kBrokenProducts) {
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

class SceneOfALook : public ProductOfAFile {
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
