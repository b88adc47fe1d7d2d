// read_gltf: the nodes, primitives and materials of a glTF file as one mesh in the world's frame.
#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "core/error.h"
#include "mesh/because.h"
#include "mesh/gltf_parts.h"

namespace livery {

namespace {

/// Of all uses of all meshes; about 0.8 GB as vertices of their own.
constexpr std::size_t kMaxCorners = 1u << 24u;

/// Of primitives by nodes, with or without triangles in them.
constexpr std::size_t kMaxUses = 1u << 17u;

using Notes = std::vector<std::string>;

/// Hands out names that differ: "wheel", "wheel-2", "wheel-3".
class UniqueNames {
  public:
    std::string take(const std::string& wanted) {
        std::string name = wanted;
        int& last = last_number_[wanted];
        while (!taken_.insert(name).second) name = fmt::format("{}-{}", wanted, ++last);
        last = std::max(last, 1);
        return name;
    }

  private:
    std::set<std::string> taken_;
    std::map<std::string, int> last_number_;
};

/// Primitives that share a material become one part.
struct MaterialGroup {
    std::optional<std::size_t> material;
    std::vector<std::size_t> primitives;
};

std::vector<MaterialGroup> group_by_material(const JsonReader& root, const JsonReader& primitives) {
    std::vector<MaterialGroup> groups;
    std::map<std::optional<std::size_t>, std::size_t> group_of;
    for (std::size_t k = 0; k < primitives.size(); ++k) {
        const auto primitive = primitives.at(k);
        std::optional<std::size_t> material;
        if (primitive.has("material")) {
            material = index_into(root, "materials", primitive["material"]);
        }
        const auto [known, is_new] = group_of.try_emplace(material, groups.size());
        if (is_new) groups.push_back({material, {}});
        groups[known->second].primitives.push_back(k);
    }
    return groups;
}

void note_unread(const JsonReader& root, Notes& notes) {
    if (root.has("extensionsUsed")) {
        for (std::size_t k = 0; k < root["extensionsUsed"].size(); ++k) {
            const std::string name = root["extensionsUsed"].at(k).text();
            // Each material says what it has that is not read.
            const bool of_materials =
                name.starts_with("KHR_materials_") && name != "KHR_materials_variants";
            if (name != "KHR_mesh_quantization" && !of_materials) {
                notes.push_back(name + " is not read");
            }
        }
    }
    for (const char* feature : {"skins", "animations"}) {
        if (root.has(feature)) {
            notes.push_back(fmt::format("{} are not read; the mesh is shown at rest", feature));
        }
    }
}

/// Adds up what the nodes would make of the meshes, from declared counts, before anything is made.
void check_total_size(const JsonReader& root, const std::vector<PlacedNode>& nodes) {
    std::size_t corners = 0, uses = 0;
    for (const auto& placed : nodes) {
        const auto node = root["nodes"].at(placed.index);
        if (!node.has("mesh")) continue;
        const auto primitives =
            root["meshes"].at(index_into(root, "meshes", node["mesh"]))["primitives"];
        for (std::size_t k = 0; k < primitives.size(); ++k) {
            const auto primitive = primitives.at(k);
            if (++uses > kMaxUses) {
                node["mesh"].fail(fmt::format("{} uses of primitives up to here", uses),
                                  fmt::format("at most {}", kMaxUses));
            }
            const auto index = primitive.has("indices") ? primitive["indices"]
                                                        : primitive["attributes"]["POSITION"];
            const auto accessor = root["accessors"].at(index_into(root, "accessors", index));
            const auto count = static_cast<std::size_t>(accessor["count"].integer(1, 0x7fffffff));
            // Strips and fans make up to three corners of one.
            corners += integer_or(primitive, "mode", 0, 6, 4) > 4 ? 3 * count : count;
            if (corners <= kMaxCorners) continue;
            node["mesh"].fail(fmt::format("{} corners of triangles up to here", corners),
                              fmt::format("at most {} in all uses of all meshes", kMaxCorners));
        }
    }
}

bool uses_extension(const JsonReader& root, std::string_view name) {
    if (!root.has("extensionsUsed")) return false;
    for (std::size_t k = 0; k < root["extensionsUsed"].size(); ++k) {
        if (root["extensionsUsed"].at(k).text() == name) return true;
    }
    return false;
}

}  // namespace

Mesh read_gltf(const std::string& bytes, const std::filesystem::path& file, Notes& notes) {
    const GltfFile gltf = open_gltf(bytes, file);
    const auto root = gltf.root();
    note_unread(root, notes);
    const bool quantized = uses_extension(root, "KHR_mesh_quantization");
    std::vector<Part> materials;
    const std::size_t material_count = root.has("materials") ? root["materials"].size() : 0;
    for (std::size_t k = 0; k < material_count; ++k) {
        materials.push_back(read_gltf_material(gltf, k, notes));
    }

    const auto nodes = placed_nodes(root);
    check_total_size(root, nodes);

    GltfAccessors accessors(gltf);
    UniqueNames names;
    Mesh mesh;
    for (const auto& [node_index, world_from_node] : nodes) {
        const auto node = root["nodes"].at(node_index);
        if (!node.has("mesh")) continue;
        const auto source = root["meshes"].at(index_into(root, "meshes", node["mesh"]));
        const auto primitives = source["primitives"];
        const auto groups = group_by_material(root, primitives);
        const std::string node_name =
            name_or(node, name_or(source, fmt::format("node {}", node_index)));
        for (const auto& group : groups) {
            Part part;
            if (group.material) part = materials[*group.material];
            const std::string material = group.material ? part.material_name : "no material";
            part.name = names.take(groups.size() > 1 ? node_name + "/" + material : node_name);
            Mesh built;
            for (const std::size_t k : group.primitives) {
                const auto primitive = primitives.at(k);
                append(built,
                       build_primitive(
                           accessors, primitive, world_from_node, quantized, part.name, notes),
                       "");
            }
            if (built.triangles.empty()) {
                notes.push_back(fmt::format("part \"{}\": nothing to show; dropped", part.name));
                continue;
            }
            if (mesh.parts.size() == 0xffff) node["mesh"].fail("part 65536", "65535 parts or less");
            built.parts = {part};
            append(mesh, built, "");
        }
    }
    if (mesh.triangles.empty()) {
        throw FileError(file, "", "no triangles" + because(notes), "at least one");
    }
    return mesh;
}

}  // namespace livery
