#include <cmath>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "mesh/gltf_builder.h"
#include "mesh/mesh_checks.h"
#include "scene/product.h"
#include "support/reference_data.h"
#include "support/temporary_folder.h"

namespace livery {
namespace {

using Words = std::vector<std::uint16_t>;
using Floats = std::vector<float>;

class LoadMesh : public ::testing::Test {
  protected:
    Mesh load(const GltfBuilder& gltf) {
        notes_.clear();
        return load_mesh(folder_.write("mesh.glb", gltf.glb()), &notes_);
    }
    TemporaryFolder folder_;
    std::vector<std::string> notes_;
};

TEST_F(LoadMesh, ReadsMetresAsMillimetres) {
    const Mesh mesh = load(make_plate());
    EXPECT_TRUE(notes_.empty());
    EXPECT_EQ(mesh.parts.at(0).name, "plate");
    EXPECT_NEAR(area_mm2(mesh), 1e6, 1.0);
    expect_consistent(mesh);
    // u runs along +x; v runs down, so that the bitangent (up) is +y = cross(+z, +x).
    EXPECT_NEAR(glm::distance(mesh.tangents[0], glm::vec4(1, 0, 0, 1)), 0.0, 1e-6);
}

TEST_F(LoadMesh, ReadsTextFilesWithDataUrisAndFilesBesideThem) {
    GltfBuilder plate = make_plate();
    const Mesh wanted = load(plate);

    static const char* digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    std::uint32_t bits = 0;
    unsigned held = 0;
    for (const char c : plate.binary) {
        bits = (bits << 8u) | static_cast<unsigned char>(c);
        for (held += 8; held >= 6; held -= 6) text.push_back(digits[(bits >> (held - 6)) & 63u]);
    }
    if (held > 0) text.push_back(digits[(bits << (6 - held)) & 63u]);
    while (text.size() % 4 != 0) text.push_back('=');
    plate.json["buffers"][0]["uri"] = "data:application/octet-stream;base64," + text;
    EXPECT_EQ(load_mesh(folder_.write("a.gltf", plate.json.dump())).positions_mm,
              wanted.positions_mm);

    folder_.write("the plate.bin", plate.binary + "more");
    plate.json["buffers"][0]["uri"] = "the%20plate.bin";
    EXPECT_EQ(load_mesh(folder_.write("b.gltf", plate.json.dump())).positions_mm,
              wanted.positions_mm);
}

TEST_F(LoadMesh, AppliesNodesFromTheRootDown) {
    GltfBuilder plate = make_plate();
    // 90 degrees about +y takes +x to -z; the parent then doubles and moves.
    plate.json["nodes"] = Json::parse(R"([
        {"name": "plate", "mesh": 0, "rotation": [0, 0.70710678118654757, 0, 0.70710678118654757]},
        {"name": "holder", "children": [0], "translation": [1, 0, 0], "scale": [2, 2, 2]}])");
    plate.json["scenes"][0]["nodes"] = {1};
    const Mesh mesh = load(plate);
    EXPECT_NEAR(glm::distance(mesh.positions_mm[1], glm::vec3(1000, 0, -2000)), 0.0, 1e-3);
    EXPECT_NEAR(glm::distance(mesh.normals[0], glm::vec3(1, 0, 0)), 0.0, 1e-6);
    EXPECT_NEAR(area_mm2(mesh), 4e6, 4.0);
    expect_consistent(mesh);
}

TEST_F(LoadMesh, AMirrorTurnsTheWindingAndTheTangentSide) {
    GltfBuilder plate = make_plate();
    plate.attributes()["TANGENT"] =
        plate.add(Floats{1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1}, "VEC4", 5126, 4);
    plate.node()["matrix"] = {-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    const Mesh mesh = load(plate);
    expect_consistent(mesh);
    EXPECT_NEAR(glm::distance(mesh.normals[0], glm::vec3(0, 0, 1)), 0.0, 1e-6);
    EXPECT_NEAR(glm::distance(mesh.tangents[0], glm::vec4(-1, 0, 0, -1)), 0.0, 1e-6);
    // The same from the UVs alone.
    plate.attributes().erase("TANGENT");
    EXPECT_NEAR(glm::distance(load(plate).tangents[0], glm::vec4(-1, 0, 0, -1)), 0.0, 1e-6);
}

TEST_F(LoadMesh, UnevenScaleKeepsNormalsUpright) {
    GltfBuilder slope;
    // A slope of 45 degrees; stretched 3 times along x its normal leans by atan(1/3).
    slope.attributes()["POSITION"] = slope.add(Floats{0, 0, 0, 0, 0, 1, 1, 1, 0}, "VEC3", 5126, 3);
    const float h = std::sqrt(0.5f);
    slope.attributes()["NORMAL"] = slope.add(Floats{-h, h, 0, -h, h, 0, -h, h, 0}, "VEC3", 5126, 3);
    slope.node()["scale"] = {3, 1, 1};
    const Mesh mesh = load(slope);
    expect_consistent(mesh);
    const glm::vec3 wanted = glm::normalize(glm::vec3(-1, 3, 0));
    EXPECT_NEAR(glm::distance(mesh.normals[0], wanted), 0.0, 1e-6);
}

TEST_F(LoadMesh, StripsAndFansMakeTheSameSquare) {
    GltfBuilder strip = make_plate();
    strip.primitive()["mode"] = 5;
    strip.primitive()["indices"] = strip.add(Words{0, 1, 3, 2}, "SCALAR", 5123, 4);
    EXPECT_NEAR(area_mm2(load(strip)), 1e6, 1.0);
    expect_consistent(load(strip));

    GltfBuilder fan = make_plate();
    fan.primitive()["mode"] = 6;
    fan.primitive().erase("indices");
    EXPECT_NEAR(area_mm2(load(fan)), 1e6, 1.0);
    expect_consistent(load(fan));
}

TEST_F(LoadMesh, PointsAndLinesAreDroppedWithANote) {
    GltfBuilder plate = make_plate();
    Json lines = plate.primitive();
    lines["mode"] = 1;
    plate.json["meshes"][0]["primitives"].push_back(lines);
    EXPECT_EQ(load(plate).triangles.size(), 2u);
    EXPECT_EQ(notes_, std::vector<std::string>{"part \"plate\": lines dropped"});
}

TEST_F(LoadMesh, TrianglesWithoutAreaAreDroppedWithANote) {
    GltfBuilder plate = make_plate();
    plate.primitive()["indices"] = plate.add(Words{0, 1, 2, 0, 2, 3, 1, 1, 2}, "SCALAR", 5123, 9);
    EXPECT_EQ(load(plate).triangles.size(), 2u);
    EXPECT_EQ(notes_, std::vector<std::string>{"part \"plate\": 1 triangles without area dropped"});
}

TEST_F(LoadMesh, MissingNormalsAreFlatAndMissingTangentsAndUvsAreFilled) {
    GltfBuilder roof;
    // Two slopes that share their ridge (vertices 0 and 1).
    roof.attributes()["POSITION"] =
        roof.add(Floats{0, 1, 0, 0, 1, 1, 1, 0, 0, -1, 0, 0}, "VEC3", 5126, 4);
    roof.primitive()["indices"] = roof.add(Words{0, 1, 2, 1, 0, 3}, "SCALAR", 5123, 6);
    const Mesh mesh = load(roof);
    expect_consistent(mesh);
    EXPECT_EQ(mesh.positions_mm.size(), 6u);
    const float h = std::sqrt(0.5f);
    EXPECT_NEAR(glm::distance(mesh.normals[mesh.triangles[0].x], glm::vec3(h, h, 0)), 0.0, 1e-6);
    EXPECT_NEAR(glm::distance(mesh.normals[mesh.triangles[1].x], glm::vec3(-h, h, 0)), 0.0, 1e-6);
    EXPECT_EQ(notes_, std::vector<std::string>{"part \"plate\": no normals; flat ones computed"});
}

TEST_F(LoadMesh, NormalsWithoutLengthAreComputedAnew) {
    GltfBuilder plate = make_plate();
    plate.attributes()["NORMAL"] =
        plate.add(Floats{0, 0, 1, 0, 0, 0, 0, 0, 5, 0, 0, 1}, "VEC3", 5126, 4);
    expect_consistent(load(plate));
    EXPECT_EQ(notes_,
              std::vector<std::string>{"part \"plate\": 1 normals of no length computed anew"});
}

TEST_F(LoadMesh, OnePartANodeAndMaterialWithNamesThatDiffer) {
    GltfBuilder plate = make_plate();
    plate.json["materials"] = Json::parse(R"([
        {"name": "red", "pbrMetallicRoughness": {"baseColorFactor": [0.8, 0.1, 0.05, 1]}},
        {"name": "plain"}])");
    // Side by side: of what lies on something else nothing is kept.
    const auto beside = [&](float x, int material) {
        Json primitive = plate.primitive();
        primitive["attributes"]["POSITION"] =
            plate.add(Floats{x, 0, 0, x + 1, 0, 0, x + 1, 1, 0, x, 1, 0}, "VEC3", 5126, 4);
        primitive["material"] = material;
        return primitive;
    };
    Json& primitives = plate.json["meshes"][0]["primitives"];
    primitives = Json::array({beside(0, 0), beside(2, 1), beside(4, 0)});
    plate.json["nodes"] = Json::parse(R"([
        {"name": "wheel", "mesh": 0},
        {"name": "wheel", "mesh": 0, "translation": [0, 2, 0]},
        {"mesh": 0, "translation": [0, 4, 0]}])");
    plate.json["scenes"][0]["nodes"] = {0, 1, 2};
    const Mesh mesh = load(plate);
    std::vector<std::string> names;
    for (const auto& part : mesh.parts) names.push_back(part.name);
    EXPECT_EQ(names,
              (std::vector<std::string>{"wheel/red",
                                        "wheel/plain",
                                        "wheel/red-2",
                                        "wheel/plain-2",
                                        "node 2/red",
                                        "node 2/plain"}));
    EXPECT_EQ(mesh.triangles.size(), 18u);
    EXPECT_EQ(mesh.parts[0].material_name, "red");
    EXPECT_EQ(mesh.parts[0].base_colour_rec709, glm::dvec3(0.8, 0.1, 0.05));
    EXPECT_EQ(mesh.parts[1].base_colour_rec709, glm::dvec3(1.0));
}

TEST_F(LoadMesh, ReadsNormalisedAndQuantisedIntegersAndStrides) {
    GltfBuilder plate = make_plate();
    plate.json["extensionsUsed"] = {"KHR_mesh_quantization"};
    plate.json["extensionsRequired"] = {"KHR_mesh_quantization"};
    // Positions as normalised signed 16 bit, four to an element: the fourth is padding.
    plate.attributes()["POSITION"] = plate.add(
        std::vector<std::int16_t>{
            0, 0, 0, 9, 32767, 0, 0, 9, 32767, 32767, 0, 9, -32768, 32767, 0, 9},
        "VEC3",
        5122,
        4);
    plate.accessor(4)["normalized"] = true;
    plate.view(4)["byteStride"] = 8;
    plate.attributes()["TEXCOORD_0"] = plate.add(
        std::vector<std::uint8_t>{0, 255, 0, 0, 255, 255, 0, 0, 255, 0, 0, 0, 51, 0, 0, 0},
        "VEC2",
        5121,
        4);
    plate.accessor(5)["normalized"] = true;
    plate.view(5)["byteStride"] = 4;
    const Mesh mesh = load(plate);
    EXPECT_EQ(mesh.positions_mm[2], glm::vec3(1000, 1000, 0));
    EXPECT_EQ(mesh.positions_mm[3], glm::vec3(-1000, 1000, 0));
    EXPECT_NEAR(mesh.uvs[3].x, 0.2f, 1e-6f);
}

TEST_F(LoadMesh, SparseAccessorsReplaceElements) {
    GltfBuilder plate = make_plate();
    const int places = plate.add_view(Words{1, 2});
    const int values = plate.add_view(Floats{3, 0, 0, 3, 1, 0});
    plate.accessor(0)["sparse"] = {{"count", 2},
                                   {"indices", {{"bufferView", places}, {"componentType", 5123}}},
                                   {"values", {{"bufferView", values}}}};
    EXPECT_NEAR(area_mm2(load(plate)), 3e6, 3.0);

    // Without a buffer view, the elements that are not replaced are zero.
    plate.accessor(0).erase("bufferView");
    const Mesh mesh = load(plate);
    EXPECT_EQ(mesh.triangles.size(), 1u);
    EXPECT_EQ(mesh.positions_mm[0], glm::vec3(0.0f));
}

TEST_F(LoadMesh, IndicesWithoutABufferViewAreZeros) {
    GltfBuilder plate = make_plate();
    plate.accessor(3).erase("bufferView");
    const int places = plate.add_view(Words{1, 2});
    const int values = plate.add_view(Words{1, 2});
    plate.accessor(3)["sparse"] = {{"count", 2},
                                   {"indices", {{"bufferView", places}, {"componentType", 5123}}},
                                   {"values", {{"bufferView", values}}}};
    EXPECT_EQ(load(plate).triangles.size(), 1u);
}

TEST_F(LoadMesh, WholeNumbersMayBeWrittenWithAPoint) {
    GltfBuilder plate = make_plate();
    plate.accessor(0)["count"] = 4.0;
    plate.accessor(0)["componentType"] = 5126.0;
    plate.view(0)["byteLength"] = 48.0;
    plate.node()["mesh"] = 0.0;
    plate.primitive()["mode"] = 4.0;
    EXPECT_NEAR(area_mm2(load(plate)), 1e6, 1.0);
}

TEST_F(LoadMesh, DataUrisNeedNoBase64) {
    GltfBuilder corner;
    corner.attributes()["POSITION"] =
        corner.add(Floats{0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3", 5126, 3);
    std::string text;
    for (const char c : corner.binary) {
        text += fmt::format("%{:02X}", static_cast<unsigned>(static_cast<unsigned char>(c)));
    }
    corner.json["buffers"][0]["uri"] = "data:application/octet-stream," + text;
    EXPECT_NEAR(area_mm2(load_mesh(folder_.write("a.gltf", corner.json.dump()))), 5e5, 1.0);
}

TEST_F(LoadMesh, CompressedPrimitivesAreReadWhereTheirNumbersAreThereASecondTime) {
    GltfBuilder plate = make_plate();
    plate.json["extensionsUsed"] = {"KHR_draco_mesh_compression"};
    plate.primitive()["extensions"]["KHR_draco_mesh_compression"] = {{"bufferView", 0}};
    EXPECT_EQ(load(plate).triangles.size(), 2u);
    EXPECT_EQ(notes_, std::vector<std::string>{"KHR_draco_mesh_compression is not read"});
}

TEST_F(LoadMesh, HiddenNodesAndWhatHasNoPositionsAreDroppedWithANote) {
    GltfBuilder plate = make_plate();
    Json hidden = plate.node();
    hidden["extensions"]["KHR_node_visibility"]["visible"] = false;
    hidden["children"] = {2};
    plate.json["nodes"].push_back(hidden);
    plate.json["nodes"].push_back(plate.node());
    plate.json["scenes"][0]["nodes"].push_back(1);
    Json bare = plate.primitive();
    bare["attributes"].erase("POSITION");
    plate.json["meshes"][0]["primitives"].push_back(bare);
    EXPECT_EQ(load(plate).triangles.size(), 2u);
    EXPECT_EQ(
        notes_,
        (std::vector<std::string>{"nodes[1] is not visible; dropped",
                                  "meshes[0].primitives[1].attributes has no POSITION; dropped"}));
}

TEST_F(LoadMesh, NotesWhatItDoesNotRead) {
    GltfBuilder plate = make_plate();
    plate.json["extensionsUsed"] = {"KHR_texture_transform"};
    plate.json["extensionsRequired"] = {"KHR_texture_transform"};
    plate.json["animations"] = Json::array({Json::object()});
    plate.json["cameras"] = Json::array({Json::object()});
    load(plate);
    EXPECT_EQ(notes_,
              (std::vector<std::string>{"animations are not read; the mesh is shown at rest",
                                        "cameras are not read"}));
}

TEST_F(LoadMesh, SplitsATruckByItsNodes) {
    LIVERY_NEEDS_REFERENCE_DATA(data);
    for (const char* name : {"vehicle-truck-green.glb", "vehicle-truck-red.glb"}) {
        const Product truck = load_product(data / "meshes" / name);
        for (const char* part : {"body", "underside", "wheel-front-left", "wheel-back-right"}) {
            EXPECT_NO_THROW(part_index(truck, part)) << name;
        }
        const Bounds bounds = bounds_of(truck.mesh);
        EXPECT_NEAR(bounds.high.x - bounds.low.x, 1500.0, 1e-3);
        EXPECT_EQ(truck.notes.at(0),
                  "material \"colormap\": the picture \"Textures/colormap.png\" is missing; its "
                  "plain colour is shown");
    }
}

}  // namespace
}  // namespace livery
