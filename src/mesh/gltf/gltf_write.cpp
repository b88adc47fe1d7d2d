#include "mesh/gltf/gltf_write.h"

#include <cstring>
#include <limits>
#include <set>
#include <sstream>
#include <stdexcept>

#include <fmt/format.h>
#include <glm/common.hpp>

#include "appearance/material_json.h"
#include "core/error.h"
#include "mesh/gltf/gltf_words.h"

namespace livery {

namespace {

using Value = tinygltf::Value;
constexpr float kMetresPerMm = 1e-3f;

/// Numbers appended to the one buffer, with a view and an accessor of their own.
template <typename T>
int add_accessor(tinygltf::Model& model,
                 const std::vector<T>& elements,
                 int type,
                 int component_type,
                 int target) {
    std::vector<unsigned char>& data = model.buffers[0].data;
    tinygltf::BufferView view;
    view.buffer = 0;
    view.byteOffset = data.size();
    view.byteLength = elements.size() * sizeof(T);
    view.target = target;
    data.resize(data.size() + view.byteLength);
    std::memcpy(data.data() + view.byteOffset, elements.data(), view.byteLength);
    model.bufferViews.push_back(view);
    tinygltf::Accessor accessor;
    accessor.bufferView = static_cast<int>(model.bufferViews.size()) - 1;
    accessor.componentType = component_type;
    accessor.count = elements.size();
    accessor.type = type;
    model.accessors.push_back(accessor);
    return static_cast<int>(model.accessors.size()) - 1;
}

/// A part's triangles with the vertices that they use.
tinygltf::Primitive part_primitive(tinygltf::Model& model, const Mesh& mesh, std::size_t part) {
    constexpr std::uint32_t kUnused = std::numeric_limits<std::uint32_t>::max();
    std::vector<std::uint32_t> own(mesh.positions_mm.size(), kUnused), indices, used;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        if (mesh.triangle_part[t] != part) continue;
        for (int k = 0; k < 3; ++k) {
            const std::uint32_t vertex = mesh.triangles[t][k];
            if (own[vertex] == kUnused) {
                own[vertex] = static_cast<std::uint32_t>(used.size());
                used.push_back(vertex);
            }
            indices.push_back(own[vertex]);
        }
    }
    const auto of_used = [&used](const auto& all) {
        std::decay_t<decltype(all)> list;
        for (const std::uint32_t vertex : used) list.push_back(all[vertex]);
        return list;
    };
    auto positions = of_used(mesh.positions_mm);
    for (glm::vec3& position : positions) position *= kMetresPerMm;
    glm::vec3 low = positions.front(), high = low;
    for (const glm::vec3& position : positions) {
        low = glm::min(low, position);
        high = glm::max(high, position);
    }
    constexpr int kFloat = TINYGLTF_COMPONENT_TYPE_FLOAT, kVertices = TINYGLTF_TARGET_ARRAY_BUFFER;
    tinygltf::Primitive primitive;
    primitive.mode = TINYGLTF_MODE_TRIANGLES;
    const int at = add_accessor(model, positions, TINYGLTF_TYPE_VEC3, kFloat, kVertices);
    tinygltf::Accessor& accessor = model.accessors.back();
    accessor.minValues = {low.x, low.y, low.z};
    accessor.maxValues = {high.x, high.y, high.z};
    primitive.attributes = {
        {"POSITION", at},
        {"NORMAL",
         add_accessor(model, of_used(mesh.normals), TINYGLTF_TYPE_VEC3, kFloat, kVertices)},
        {"TANGENT",
         add_accessor(model, of_used(mesh.tangents), TINYGLTF_TYPE_VEC4, kFloat, kVertices)},
        {"TEXCOORD_0",
         add_accessor(model, of_used(mesh.uvs), TINYGLTF_TYPE_VEC2, kFloat, kVertices)}};
    primitive.indices = add_accessor(model,
                                     indices,
                                     TINYGLTF_TYPE_SCALAR,
                                     TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT,
                                     TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER);
    return primitive;
}

/// The paints' materials, each once.
class PaintMaterials {
  public:
    PaintMaterials(tinygltf::Model& model, std::vector<std::string>& notes)
        : model_(model), notes_(notes) {}

    int of(const Material& paint) {
        const bool measured = is_measured(paint);
        const std::string text = measured ? paint.file.string() : text_of(paint);
        const auto [known, is_new] =
            index_of_.try_emplace({paint.name, text}, static_cast<int>(model_.materials.size()));
        if (!is_new) return known->second;
        const GltfWords words = words_of(paint);
        tinygltf::Material material;
        material.name = paint.name;
        put_words(words, material);
        if (measured) {
            notes_.push_back(fmt::format(
                "\"{}\" is measured: the file has only its colour and roughness", paint.name));
        } else if (!words.whole) {
            material.extras = Value(Value::Object{{kPaintInExtras, Value(text)}});
        }
        for (const auto& [name, value] : material.extensions) extensions_.insert(name);
        model_.materials.push_back(std::move(material));
        return known->second;
    }
    const std::set<std::string>& extensions() const { return extensions_; }

  private:
    tinygltf::Model& model_;
    std::vector<std::string>& notes_;
    std::map<std::pair<std::string, std::string>, int> index_of_;
    std::set<std::string> extensions_;
};

/// Which material a part wears in which looks.
Value mappings_of(const std::vector<int>& material_of_look) {
    std::map<int, Value::Array> looks_of;
    for (std::size_t k = 0; k < material_of_look.size(); ++k) {
        looks_of[material_of_look[k]].emplace_back(static_cast<int>(k));
    }
    Value::Array mappings;
    for (auto& [material, looks] : looks_of) {
        mappings.emplace_back(
            Value::Object{{"material", Value(material)}, {"variants", Value(std::move(looks))}});
    }
    return Value(Value::Object{{"mappings", Value(std::move(mappings))}});
}

}  // namespace

std::string gltf_bytes(const Mesh& mesh,
                       std::span<const MeshLook> looks,
                       std::vector<std::string>& notes) {
    check_argument(!looks.empty(), "gltf_bytes: no look");
    for (const MeshLook& look : looks) {
        check_argument(look.part_materials.size() == mesh.parts.size(),
                       fmt::format("gltf_bytes: look \"{}\" has {} materials for {} parts",
                                   look.name,
                                   look.part_materials.size(),
                                   mesh.parts.size()));
    }
    tinygltf::Model model;
    model.asset.version = "2.0";
    model.asset.generator = "Livery";
    model.buffers.resize(1);
    PaintMaterials materials(model, notes);
    tinygltf::Scene scene;
    const std::set<std::uint16_t> shown(mesh.triangle_part.begin(), mesh.triangle_part.end());
    for (const std::size_t part : shown) {
        std::vector<int> worn;
        for (const MeshLook& look : looks) worn.push_back(materials.of(look.part_materials[part]));
        tinygltf::Primitive primitive = part_primitive(model, mesh, part);
        primitive.material = worn.front();
        primitive.extensions[kVariantsExtension] = mappings_of(worn);
        tinygltf::Mesh own;
        own.name = mesh.parts[part].name;
        own.primitives.push_back(std::move(primitive));
        tinygltf::Node node;
        node.name = own.name;
        node.mesh = static_cast<int>(model.meshes.size());
        scene.nodes.push_back(node.mesh);
        model.meshes.push_back(std::move(own));
        model.nodes.push_back(std::move(node));
    }
    Value::Array names;
    for (const MeshLook& look : looks) {
        names.emplace_back(Value::Object{{"name", Value(look.name)}});
    }
    model.extensions[kVariantsExtension] =
        Value(Value::Object{{"variants", Value(std::move(names))}});
    model.extensionsUsed.assign(materials.extensions().begin(), materials.extensions().end());
    model.extensionsUsed.emplace_back(kVariantsExtension);
    model.scenes.push_back(std::move(scene));
    model.defaultScene = 0;

    std::ostringstream stream;
    if (!tinygltf::TinyGLTF().WriteGltfSceneToStream(&model, stream, false, true)) {
        throw std::runtime_error("the mesh could not be written as glTF");
    }
    return stream.str();
}

}  // namespace livery
