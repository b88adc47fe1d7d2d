#include "glb.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>

#include <nlohmann/json.hpp>

namespace livery::assets {

namespace {

using Json = nlohmann::ordered_json;

constexpr int kFloat = 5126, kUnsignedInt = 5125;
constexpr int kVertexBuffer = 34962, kIndexBuffer = 34963;

/// The buffer under construction with the JSON that describes it. glTF is little endian, as is
/// every machine that this runs on.
struct Writer {
    std::string bytes;
    Json views = Json::array();
    Json accessors = Json::array();

    template <typename T>
    int add(const std::vector<T>& numbers, int components, const char* type, int kind, int target) {
        views.push_back({{"buffer", 0},
                         {"byteOffset", bytes.size()},
                         {"byteLength", numbers.size() * sizeof(T)},
                         {"target", target}});
        bytes.append(reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(T));
        std::vector<T> low(numbers.begin(), numbers.begin() + components), high = low;
        for (std::size_t k = 0; k < numbers.size(); ++k) {
            const auto c = k % static_cast<std::size_t>(components);
            low[c] = std::min(low[c], numbers[k]);
            high[c] = std::max(high[c], numbers[k]);
        }
        accessors.push_back({{"bufferView", views.size() - 1},
                             {"componentType", kind},
                             {"count", numbers.size() / static_cast<std::size_t>(components)},
                             {"type", type},
                             {"min", low},
                             {"max", high}});
        return static_cast<int>(accessors.size() - 1);
    }
};

template <int N, typename V>
std::vector<float> flatten(const std::vector<V>& vectors, double scale = 1.0) {
    std::vector<float> flat;
    flat.reserve(vectors.size() * N);
    for (const auto& v : vectors) {
        for (int k = 0; k < N; ++k) flat.push_back(static_cast<float>(v[k] * scale));
    }
    return flat;
}

void append_u32(std::string& bytes, std::size_t value) {
    const auto word = static_cast<std::uint32_t>(value);
    std::array<char, 4> raw{};
    std::memcpy(raw.data(), &word, 4);
    bytes.append(raw.data(), 4);
}

void append_chunk(std::string& bytes, std::string content, const char* kind, char padding) {
    content.resize((content.size() + 3) / 4 * 4, padding);
    append_u32(bytes, content.size());
    bytes.append(kind, 4);
    bytes += content;
}

}  // namespace

std::string glb_bytes(const std::string& name, const std::vector<PartMesh>& parts) {
    constexpr double kMetresPerMm = 1e-3;
    Writer buffer;
    Json nodes = Json::array(), meshes = Json::array(), materials = Json::array();
    Json roots = Json::array();
    for (const auto& part : parts) {
        std::vector<std::uint32_t> indices;
        for (const auto& t : part.triangles) indices.insert(indices.end(), {t.x, t.y, t.z});
        const auto add = [&](const std::vector<float>& values, int components, const char* type) {
            return buffer.add(values, components, type, kFloat, kVertexBuffer);
        };
        Json attributes;
        attributes["POSITION"] = add(flatten<3>(part.positions_mm, kMetresPerMm), 3, "VEC3");
        attributes["NORMAL"] = add(flatten<3>(part.normals), 3, "VEC3");
        attributes["TANGENT"] = add(flatten<4>(part.tangents), 4, "VEC4");
        attributes["TEXCOORD_0"] = add(flatten<2>(part.uvs), 2, "VEC2");
        const int index = buffer.add(indices, 1, "SCALAR", kUnsignedInt, kIndexBuffer);
        meshes.push_back({{"name", part.name},
                          {"primitives",
                           Json::array({{{"attributes", attributes},
                                         {"indices", index},
                                         {"material", materials.size()}}})}});
        const auto& colour = part.base_colour_rec709;
        materials.push_back({{"name", part.name},
                             {"pbrMetallicRoughness",
                              {{"baseColorFactor", {colour.x, colour.y, colour.z, 1.0}},
                               {"metallicFactor", 0.0},
                               {"roughnessFactor", part.roughness}}}});
        roots.push_back(nodes.size());
        nodes.push_back({{"name", part.name}, {"mesh", meshes.size() - 1}});
    }
    const Json document{{"asset", {{"version", "2.0"}, {"generator", "livery_generate_assets"}}},
                        {"scene", 0},
                        {"scenes", Json::array({{{"name", name}, {"nodes", roots}}})},
                        {"nodes", nodes},
                        {"meshes", meshes},
                        {"materials", materials},
                        {"buffers", Json::array({{{"byteLength", buffer.bytes.size()}}})},
                        {"bufferViews", buffer.views},
                        {"accessors", buffer.accessors}};
    std::string chunks;
    append_chunk(chunks, document.dump(), "JSON", ' ');
    append_chunk(chunks, buffer.bytes, std::string("BIN\0", 4).c_str(), '\0');
    std::string bytes = "glTF";
    append_u32(bytes, 2);
    append_u32(bytes, 12 + chunks.size());
    return bytes + chunks;
}

}  // namespace livery::assets
