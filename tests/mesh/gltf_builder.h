// Small glTF files made in memory, to be broken one field at a time.
#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "core/json.h"

namespace livery {

/// A file with one buffer; accessors are appended to it.
struct GltfBuilder {
    Json json = Json::parse(R"({"asset": {"version": "2.0"}, "scene": 0,
        "scenes": [{"nodes": [0]}], "nodes": [{"name": "plate", "mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {}}]}],
        "accessors": [], "bufferViews": [], "buffers": [{"byteLength": 0}]})");
    std::string binary;

    Json& primitive() { return json["meshes"][0]["primitives"][0]; }
    Json& attributes() { return primitive()["attributes"]; }
    Json& node() { return json["nodes"][0]; }
    Json& accessor(std::size_t k) { return json["accessors"][k]; }
    Json& view(std::size_t k) { return json["bufferViews"][k]; }

    /// A buffer view of its own; its index.
    template <typename T>
    int add_view(const std::vector<T>& values) {
        while (binary.size() % 4 != 0) binary.push_back('\0');
        const std::size_t offset = binary.size(), size = values.size() * sizeof(T);
        binary.resize(offset + size);
        if (size > 0) std::memcpy(binary.data() + offset, values.data(), size);
        json["bufferViews"].push_back(
            {{"buffer", 0}, {"byteOffset", offset}, {"byteLength", size}});
        json["buffers"][0]["byteLength"] = binary.size();
        return static_cast<int>(json["bufferViews"].size()) - 1;
    }
    /// An accessor over a view of its own; its index.
    template <typename T>
    int add(const std::vector<T>& values, const char* type, int component_type, std::size_t count) {
        const int made = add_view(values);
        json["accessors"].push_back({{"bufferView", made},
                                     {"componentType", component_type},
                                     {"count", count},
                                     {"type", type}});
        return static_cast<int>(json["accessors"].size()) - 1;
    }

    std::string glb() const {
        std::string text = json.dump(), bytes = binary;
        while (text.size() % 4 != 0) text.push_back(' ');
        while (bytes.size() % 4 != 0) bytes.push_back('\0');
        const auto word = [](std::size_t value) {
            const auto v = static_cast<std::uint32_t>(value);
            return std::string(reinterpret_cast<const char*>(&v), 4);
        };
        const std::string body = word(text.size()) + "JSON" + text + word(bytes.size()) +
                                 std::string("BIN\0", 4) + bytes;
        return "glTF" + word(2) + word(12 + body.size()) + body;
    }
};

/// A square metre in the plane z = 0 that faces +z, with everything a primitive can carry:
/// accessors 0 positions, 1 normals, 2 uvs, 3 indices, each over the view of the same number.
inline GltfBuilder make_plate() {
    GltfBuilder plate;
    plate.attributes()["POSITION"] =
        plate.add(std::vector<float>{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}, "VEC3", 5126, 4);
    plate.attributes()["NORMAL"] =
        plate.add(std::vector<float>{0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3", 5126, 4);
    plate.attributes()["TEXCOORD_0"] =
        plate.add(std::vector<float>{0, 1, 1, 1, 1, 0, 0, 0}, "VEC2", 5126, 4);
    plate.primitive()["indices"] =
        plate.add(std::vector<std::uint16_t>{0, 1, 2, 0, 2, 3}, "SCALAR", 5123, 6);
    return plate;
}

}  // namespace livery
