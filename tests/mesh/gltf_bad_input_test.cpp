#include <functional>
#include <limits>

#include <gtest/gtest.h>

#include "mesh/gltf_builder.h"
#include "mesh/mesh.h"
#include "support/file_error.h"
#include "support/temporary_folder.h"

namespace livery {
namespace {

using Words = std::vector<std::uint16_t>;
using Floats = std::vector<float>;

/// A plate with one thing wrong, and what a person must read about it.
struct Broken {
    const char* what;
    std::function<void(GltfBuilder&)> damage;
    std::vector<const char*> message;
};

const Broken kBroken[] = {
    {"accessor past its view",
     [](auto& g) { g.accessor(0)["count"] = 5; },
     {"accessors[0]: found 5 elements that need 60 bytes", "at most the buffer view's 48"}},
    {"accessor offset",
     [](auto& g) { g.accessor(0)["byteOffset"] = 4; },
     {"accessors[0]: found 4 elements that need 52 bytes"}},
    {"view past its buffer",
     [](auto& g) { g.view(3)["byteLength"] = 1000000; },
     {"bufferViews[3].byteLength: found 1000000 from byte 128", "140 bytes"}},
    {"view offset whose sum overflows 32 bits",
     [](auto& g) { g.view(3)["byteOffset"] = 2147483647, g.view(3)["byteLength"] = 2147483647; },
     {"bufferViews[3].byteLength: found 2147483647 from byte 2147483647"}},
    {"offset over 2 GiB",
     [](auto& g) { g.view(3)["byteOffset"] = 4294967296; },
     {"bufferViews[3].byteOffset: found 4294967296, expected a whole number between 0 and"}},
    {"negative offset",
     [](auto& g) { g.view(3)["byteOffset"] = -4; },
     {"bufferViews[3].byteOffset: found -4"}},
    {"stride below the element",
     [](auto& g) { g.view(0)["byteStride"] = 8; },
     {"bufferViews[0].byteStride: found 8, expected at least the element's 12 bytes"}},
    {"stride past the view",
     [](auto& g) { g.view(0)["byteStride"] = 16; },
     {"accessors[0]: found 4 elements that need 60 bytes"}},
    {"huge declared count",
     [](auto& g) { g.accessor(0)["count"] = 2000000000; },
     {"accessors[0].count: found 2000000000, expected at most "}},
    {"huge declared number of indices",
     [](auto& g) { g.accessor(3)["count"] = 2000000000; },
     {"nodes[0].mesh: found 2000000000 corners of triangles up to here"}},
    {"huge count without data",
     [](auto& g) { g.accessor(0)["count"] = 40000000, g.accessor(0).erase("bufferView"); },
     {"accessors[0].count: found 40000000"}},
    {"count of zero", [](auto& g) { g.accessor(0)["count"] = 0; }, {"accessors[0].count: found 0"}},
    {"buffer longer than its bytes",
     [](auto& g) { g.json["buffers"][0]["byteLength"] = 99999; },
     {"buffers[0].byteLength: found 99999, expected at most the 140 bytes"}},
    {"component type",
     [](auto& g) { g.accessor(0)["componentType"] = 5125; },
     {"accessors[0].componentType: found 5125, expected 5126"}},
    {"unknown component type",
     [](auto& g) { g.accessor(3)["componentType"] = 5124; },
     {"accessors[3].componentType: found 5124, expected 5121 or 5123 or 5125"}},
    {"element type",
     [](auto& g) { g.accessor(0)["type"] = "VEC2"; },
     {"accessors[0].type: found \"VEC2\", expected VEC3"}},
    {"normalised floats",
     [](auto& g) { g.accessor(0)["normalized"] = true; },
     {"accessors[0].normalized: found true"}},
    {"index out of range",
     [](auto& g) {
         g.primitive()["indices"] = g.add(Words{0, 1, 4}, "SCALAR", 5123, 3);
     },
     {"meshes[0].primitives[0].indices: found the vertex 4, expected indices below 4"}},
    {"half a triangle",
     [](auto& g) { g.accessor(3)["count"] = 5; },
     {"meshes[0].primitives[0]: found 5 corners, expected a multiple of three"}},
    {"unknown mode",
     [](auto& g) { g.primitive()["mode"] = 7; },
     {"meshes[0].primitives[0].mode: found 7"}},
    {"no positions",
     [](auto& g) { g.attributes().erase("POSITION"); },
     {"meshes: found no triangles (meshes[0].primitives[0].attributes has no POSITION; dropped"}},
    {"fewer normals than positions",
     [](auto& g) { g.accessor(1)["count"] = 3; },
     {"attributes.NORMAL: found 3 elements, expected 4, as many as positions"}},
    {"NaN position",
     [](auto& g) {
         g.attributes()["POSITION"] =
             g.add(Floats{0, 0, 0, 1, 0, 0, 1, std::numeric_limits<float>::quiet_NaN(), 0, 0, 1, 0},
                   "VEC3",
                   5126,
                   4);
     },
     {"accessors[4]: found a number that is not finite in element 2"}},
    {"position at the end of floats",
     [](auto& g) {
         g.attributes()["POSITION"] =
             g.add(Floats{0, 0, 0, 3e38f, 0, 0, 1, 1, 0, 0, 1, 0}, "VEC3", 5126, 4);
     },
     {"attributes.POSITION: found a vertex 3e+41 mm away"}},
    {"node that is its own child",
     [](auto& g) { g.node()["children"] = {0}; },
     {"nodes[0]: found a node reached twice (a cycle, or two parents), expected a tree"}},
    {"cycle of two that no scene names",
     [](auto& g) {
         g.json["nodes"].push_back({{"children", {0}}});
         g.node()["children"] = {1};
         g.json.erase("scenes");
         g.json.erase("scene");
     },
     {"found no triangles"}},
    {"missing child",
     [](auto& g) { g.node()["children"] = {7}; },
     {"nodes[0].children[0]: found 7, expected a whole number between 0 and 0"}},
    {"missing mesh", [](auto& g) { g.node()["mesh"] = 3; }, {"nodes[0].mesh: found 3"}},
    {"missing accessor",
     [](auto& g) { g.attributes()["NORMAL"] = 9; },
     {"attributes.NORMAL: found 9"}},
    {"missing material",
     [](auto& g) { g.primitive()["material"] = 0; },
     {"primitives[0].material: found 0, expected no index: there are no materials"}},
    {"missing scene", [](auto& g) { g.json["scene"] = 2; }, {"scene: found 2"}},
    {"projective matrix",
     [](auto& g) {
         g.node()["matrix"] = {1, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
     },
     {"nodes[0].matrix: found a projective matrix"}},
    {"short matrix",
     [](auto& g) {
         g.node()["matrix"] = {1, 0, 0};
     },
     {"nodes[0].matrix: found 3 elements, expected 16 numbers"}},
    {"rotation of no length",
     [](auto& g) {
         g.node()["rotation"] = {0, 0, 0, 0};
     },
     {"nodes[0].rotation: found [0,0,0,0], expected a unit quaternion"}},
    {"unknown required extension",
     [](auto& g) { g.json["extensionsRequired"] = {"KHR_draco_mesh_compression"}; },
     {"extensionsRequired[0]: found the extension KHR_draco_mesh_compression"}},
    {"compressed by Draco without its numbers a second time",
     [](auto& g) {
         g.primitive()["extensions"]["KHR_draco_mesh_compression"] = {{"bufferView", 0}};
         g.accessor(0).erase("bufferView");
     },
     {"meshes[0].primitives[0].extensions.KHR_draco_mesh_compression: found POSITION compressed"}},
    {"required meshopt compression",
     [](auto& g) { g.json["extensionsRequired"] = {"EXT_meshopt_compression"}; },
     {"extensionsRequired[0]: found the extension EXT_meshopt_compression"}},
    {"compressed by meshopt without its numbers a second time",
     [](auto& g) {
         g.json["buffers"].push_back({{"byteLength", 48}});
         g.view(0)["buffer"] = 1;
         g.view(0)["byteOffset"] = 0;
         g.view(0)["extensions"]["EXT_meshopt_compression"] = {{"buffer", 0}};
     },
     {"bufferViews[0]: found a view compressed by EXT_meshopt_compression"}},
    {"stride that is no multiple of four",
     [](auto& g) { g.view(0)["byteStride"] = 14; },
     {"bufferViews[0].byteStride: found 14, expected a multiple of 4"}},
    {"unknown element type",
     [](auto& g) { g.accessor(0)["type"] = "VEC9"; },
     {"accessors[0].type: found \"VEC9\", expected VEC3"}},
    {"newer version",
     [](auto& g) { g.json["asset"]["version"] = "3.0"; },
     {"asset.version: found \"3.0\", expected glTF 2.0"}},
    {"newer least version",
     [](auto& g) { g.json["asset"]["minVersion"] = "2.1"; },
     {"asset.minVersion: found \"2.1\""}},
    {"no asset", [](auto& g) { g.json.erase("asset"); }, {"asset: found nothing"}},
    {"nothing to show",
     [](auto& g) { g.node().erase("mesh"); },
     {"found no triangles, expected at least one"}},
    {"nothing to show, and why",
     [](auto& g) { g.primitive()["mode"] = 0; },
     {"found no triangles (", "points dropped", "expected at least one"}},
    {"large numbers of zeros in a small file",
     [](auto& g) {
         g.accessor(0).erase("bufferView");
         g.accessor(0)["count"] = 3000000;
     },
     {"accessors[0].count: found 3000000", "in all accessors of a file of this length"}},
    {"wrong kind of field",
     [](auto& g) { g.json["nodes"] = "many"; },
     {"nodes: found \"many\", expected an array"}},
    {"colour out of range",
     [](auto& g) {
         g.json["materials"] =
             Json::parse(R"([{"pbrMetallicRoughness": {"baseColorFactor": [1, 2, 1, 1]}}])");
     },
     {"materials[0].pbrMetallicRoughness.baseColorFactor[1]: found 2"}},
    {"sparse places that do not rise",
     [](auto& g) {
         const int places = g.add_view(Words{2, 2}), values = g.add_view(Floats{0, 0, 0, 0, 0, 0});
         g.accessor(0)["sparse"] = {{"count", 2},
                                    {"indices", {{"bufferView", places}, {"componentType", 5123}}},
                                    {"values", {{"bufferView", values}}}};
     },
     {"accessors[0].sparse.indices: found 2, expected rising indices below 4"}},
    {"sparse places out of range",
     [](auto& g) {
         const int places = g.add_view(Words{4}), values = g.add_view(Floats{0, 0, 0});
         g.accessor(0)["sparse"] = {{"count", 1},
                                    {"indices", {{"bufferView", places}, {"componentType", 5123}}},
                                    {"values", {{"bufferView", values}}}};
     },
     {"accessors[0].sparse.indices: found 4, expected rising indices below 4"}},
    {"more sparse elements than elements",
     [](auto& g) {
         const int places = g.add_view(Words{0, 1, 2, 3, 4}), values = g.add_view(Floats(15));
         g.accessor(0)["sparse"] = {{"count", 5},
                                    {"indices", {{"bufferView", places}, {"componentType", 5123}}},
                                    {"values", {{"bufferView", values}}}};
     },
     {"accessors[0].sparse.count: found 5"}},
    {"buffer on the network",
     [](auto& g) { g.json["buffers"][0]["uri"] = "http://example.com/a.bin"; },
     {"buffers[0].uri: found \"http://example.com/a.bin\", expected a file beside the model"}},
    {"buffer outside the model's folder",
     [](auto& g) { g.json["buffers"][0]["uri"] = "a/../../../etc/passwd"; },
     {"buffers[0].uri: found \"a/../../../etc/passwd\""}},
    {"buffer with an absolute name",
     [](auto& g) { g.json["buffers"][0]["uri"] = "%2Fetc%2Fpasswd"; },
     {"buffers[0].uri: found"}},
    {"missing buffer file",
     [](auto& g) { g.json["buffers"][0]["uri"] = "gone.bin"; },
     {"gone.bin: found no such file"}},
    {"data URI that is not base64",
     [](auto& g) { g.json["buffers"][0]["uri"] = "data:;base64,AAA*"; },
     {"buffers[0].uri: found a character that is not base64"}},
};

TEST(GltfBadInput, EachFieldIsNamed) {
    const TemporaryFolder folder;
    for (const auto& broken : kBroken) {
        GltfBuilder plate = make_plate();
        broken.damage(plate);
        const auto file = folder.write("mesh.glb", plate.glb());
        EXPECT_TRUE(fails_with([&] { load_mesh(file); }, {"mesh.glb"}) ||
                    fails_with([&] { load_mesh(file); }, {"gone.bin"}))
            << broken.what;
        for (const char* part : broken.message) {
            EXPECT_TRUE(fails_with([&] { load_mesh(file); }, {part})) << broken.what;
        }
    }
}

TEST(GltfBadInput, Containers) {
    const TemporaryFolder folder;
    const std::string good = make_plate().glb();
    const auto refuses = [&](std::string bytes, std::initializer_list<std::string_view> parts) {
        const auto file = folder.write("mesh.glb", bytes);
        return fails_with([&] { load_mesh(file); }, parts);
    };
    EXPECT_TRUE(
        fails_with([&] { load_mesh(folder / "gone.glb"); }, {"gone.glb: found no such file"}));
    EXPECT_TRUE(fails_with([&] { load_mesh(folder.path()); }, {"found a folder"}));
    EXPECT_TRUE(refuses("", {"found an empty file, expected a mesh"}));
    EXPECT_TRUE(refuses(good.substr(0, 15), {"header: found 15 bytes"}));
    EXPECT_TRUE(refuses(good.substr(0, 200), {"header: found 200 bytes (cut off), expected"}));
    EXPECT_TRUE(refuses("gltf\n" + good, {"header: found no \"glTF\" at the start"}));
    std::string bytes = good;
    bytes[4] = 1;
    EXPECT_TRUE(refuses(bytes, {"header: found GLB version 1, expected version 2"}));
    bytes = good;
    bytes[15] = 0x7f;  // the JSON chunk's length
    EXPECT_TRUE(refuses(bytes, {"chunk 0: found", "declared, expected at most"}));
    bytes = good;
    bytes[16] = 'X';
    EXPECT_TRUE(refuses(bytes, {"chunk 0: found no JSON, expected JSON first"}));
    bytes = good;
    bytes[20] = '[';
    EXPECT_TRUE(refuses(bytes, {"found text that is not JSON"}));
    const auto text = folder.write("mesh.gltf", "[1, 2]");
    EXPECT_TRUE(fails_with([&] { load_mesh(text); }, {"mesh.gltf: found array"}));
}

TEST(GltfBadInput, NoByteOfAFileCanDoWorseThanAnError) {
    // Every fifth byte to other values: either a mesh or a FileError, never anything else.
    const TemporaryFolder folder;
    const std::string good = make_plate().glb();
    int refused = 0;
    for (std::size_t k = 0; k < good.size(); k += 5) {
        for (const char value : {'9', '\xff'}) {
            std::string bytes = good;
            bytes[k] = value;
            const auto file = folder.write("mesh.glb", bytes);
            try {
                load_mesh(file);
            } catch (const FileError&) {
                ++refused;
            }
        }
    }
    EXPECT_GT(refused, 100);
}

TEST(GltfBadInput, DeepNodesDoNotExhaustTheStack) {
    const TemporaryFolder folder;
    GltfBuilder plate = make_plate();
    constexpr int depth = 20000;
    plate.json["nodes"] = Json::array();
    for (int k = 0; k < depth; ++k) {
        plate.json["nodes"].push_back({{"children", {k + 1}}});
    }
    plate.json["nodes"].push_back({{"mesh", 0}});
    EXPECT_EQ(load_mesh(folder.write("mesh.glb", plate.glb())).triangles.size(), 2u);
    // Half a million opening brackets: the JSON parser must not recurse either.
    const auto file = folder.write("mesh.gltf", std::string(500000, '['));
    EXPECT_TRUE(fails_with([&] { load_mesh(file); },
                           {"500000 brackets inside one another", "at most 200"}));
    const std::string inside =
        R"({"asset":)" + std::string(100000, '[') + std::string(100000, ']') + "}";
    EXPECT_TRUE(fails_with([&] { load_mesh(folder.write("mesh.gltf", inside)); },
                           {"100001 brackets inside one another"}));
}

TEST(GltfBadInput, BuffersThatNameOneFileAreReadOnce) {
    const TemporaryFolder folder;
    GltfBuilder plate = make_plate();
    folder.write("plate.bin", plate.binary + std::string(1u << 20u, '\0'));
    Json buffer = {{"uri", "plate.bin"}, {"byteLength", plate.binary.size() + (1u << 20u)}};
    plate.json["buffers"] = Json::array();
    // Read for each, they would take 20 GB.
    for (int k = 0; k < 20000; ++k) plate.json["buffers"].push_back(buffer);
    const auto file = folder.write("mesh.gltf", plate.json.dump());
    EXPECT_EQ(load_mesh(file).triangles.size(), 2u);
}

TEST(GltfBadInput, ABufferIsReadAsFarAsItIsDeclared) {
    const TemporaryFolder folder;
    GltfBuilder plate = make_plate();
    // Three gigabytes behind the plate: more than all buffers may have together.
    const auto large = folder.write("large.bin", plate.binary);
    std::filesystem::resize_file(large, std::uintmax_t{3} << 30u);
    const auto buffer = [](const char* uri, std::size_t bytes) {
        return Json{{"uri", uri}, {"byteLength", bytes}};
    };
    // The second spells the same file otherwise, and wants more of it than the first.
    plate.json["buffers"] = {buffer("./large.bin", 9), buffer("large.bin", plate.binary.size())};
    for (auto& view : plate.json["bufferViews"]) view["buffer"] = 1;
    EXPECT_EQ(load_mesh(folder.write("mesh.gltf", plate.json.dump())).triangles.size(), 2u);

    plate.json["buffers"][0]["byteLength"] = (1u << 30u) + 1u;
    const auto refused = folder.write("refused.gltf", plate.json.dump());
    EXPECT_TRUE(
        fails_with([&] { load_mesh(refused); }, {"large.bin", "more than 1073741824 bytes"}));
}

TEST(GltfBadInput, ManyUsesOfALargeMeshAreRefused) {
    const TemporaryFolder folder;
    GltfBuilder large = make_plate();
    Floats positions(3 * 300000);
    for (std::size_t k = 0; k < positions.size(); ++k)
        positions[k] = static_cast<float>(k * k % 97);
    large.attributes().clear();
    large.attributes()["POSITION"] = large.add(positions, "VEC3", 5126, positions.size() / 3);
    large.primitive().erase("indices");
    large.json["nodes"] = Json::array();
    large.json["scenes"][0]["nodes"] = Json::array();
    // 300,000 vertices used 200 times are 60 million.
    Json uses = Json::array();
    for (int k = 0; k < 200; ++k) uses.push_back(large.primitive());
    large.json["meshes"][0]["primitives"] = uses;
    large.json["nodes"].push_back({{"mesh", 0}});
    large.json["scenes"][0]["nodes"].push_back(0);
    const auto file = folder.write("mesh.glb", large.glb());
    EXPECT_TRUE(fails_with(
        [&] { load_mesh(file); },
        {"nodes[0].mesh: found 16800000 corners of triangles up to here", "at most 16777216"}));
}

}  // namespace
}  // namespace livery
