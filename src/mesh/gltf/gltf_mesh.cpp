// read_gltf: the nodes, primitives and materials of a glTF file as one mesh in the world's frame.
#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/gtc/type_ptr.hpp>

#include "core/error.h"
#include "core/utf8.h"
#include "mesh/because.h"
#include "mesh/gltf/gltf_parts.h"
#include "mesh/gltf/gltf_words.h"
#include "mesh/mesh_sides.h"

namespace livery {

namespace {

/// Of all uses of all meshes; about 0.8 GB as vertices of their own.
constexpr std::size_t kMaxCorners = 1u << 24u;

/// Of primitives by nodes, with or without triangles in them.
constexpr std::size_t kMaxUses = 1u << 17u;

/// Paints that a file may have for a part; configurators have some dozen.
constexpr std::size_t kMaxVariants = 1024;

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

/// Primitives that share a material, in every variant, become one part.
struct MaterialGroup {
    int material = -1;              ///< none
    std::map<int, int> of_variant;  ///< where a variant has another
    std::vector<std::size_t> primitives;
};

/// Which material a primitive has in which variant. Throws FileError: two in one.
std::map<int, int> variants_of(const GltfFile& gltf,
                               const tinygltf::Primitive& primitive,
                               const std::string& field) {
    std::map<int, int> materials;
    const auto extension = primitive.extensions.find(kVariantsExtension);
    if (extension == primitive.extensions.end()) return materials;
    const auto& mappings = extension->second.Get("mappings").Get<tinygltf::Value::Array>();
    for (std::size_t m = 0; m < mappings.size(); ++m) {
        const auto& variants = mappings[m].Get("variants").Get<tinygltf::Value::Array>();
        for (std::size_t k = 0; k < variants.size(); ++k) {
            const int variant = variants[k].GetNumberAsInt();
            const int material = mappings[m].Get("material").GetNumberAsInt();
            if (materials.try_emplace(variant, material).second) continue;
            gltf.fail(
                fmt::format(
                    "{}.extensions.{}.mappings[{}].variants[{}]", field, kVariantsExtension, m, k),
                fmt::format("the variant {} a second time", variant),
                "one material a variant");
        }
    }
    return materials;
}

std::vector<MaterialGroup> group_by_material(const GltfFile& gltf, int mesh) {
    const auto& primitives = gltf.model.meshes[static_cast<std::size_t>(mesh)].primitives;
    std::vector<MaterialGroup> groups;
    std::map<std::pair<int, std::map<int, int>>, std::size_t> group_of;
    for (std::size_t k = 0; k < primitives.size(); ++k) {
        const int material = primitives[k].material;
        const auto variants =
            variants_of(gltf, primitives[k], fmt::format("meshes[{}].primitives[{}]", mesh, k));
        const auto [known, is_new] = group_of.try_emplace({material, variants}, groups.size());
        if (is_new) groups.push_back({material, variants, {}});
        groups[known->second].primitives.push_back(k);
    }
    return groups;
}

bool uses_extension(const tinygltf::Model& model, std::string_view name) {
    const auto& used = model.extensionsUsed;
    return std::find(used.begin(), used.end(), name) != used.end();
}

void note_unread(const GltfFile& gltf, Notes& notes) {
    for (const std::string& name : gltf.model.extensionsUsed) {
        // Each material says what it has that is not read.
        const bool of_materials = name.starts_with("KHR_materials_");
        const bool read = name == "KHR_mesh_quantization" || name == "KHR_node_visibility" ||
                          name == "KHR_texture_transform";
        if (!read && !of_materials) notes.push_back(name + " is not read");
    }
    for (const char* feature : {"skins", "animations"}) {
        if (gltf.json.contains(feature)) {
            notes.push_back(fmt::format("{} are not read; the mesh is shown at rest", feature));
        }
    }
    if (gltf.json.contains("cameras")) notes.emplace_back("cameras are not read");
}

/// Adds up what the nodes would make of the meshes, from declared counts, before anything is made.
void check_total_size(const GltfFile& gltf, const std::vector<PlacedNode>& nodes) {
    const tinygltf::Model& model = gltf.model;
    std::size_t corners = 0, uses = 0;
    for (const auto& placed : nodes) {
        const int mesh = model.nodes[placed.index].mesh;
        if (mesh < 0) continue;
        const std::string field = fmt::format("nodes[{}].mesh", placed.index);
        for (const auto& primitive : model.meshes[static_cast<std::size_t>(mesh)].primitives) {
            if (++uses > kMaxUses) {
                gltf.fail(field,
                          fmt::format("{} uses of primitives up to here", uses),
                          fmt::format("at most {}", kMaxUses));
            }
            const auto positions = primitive.attributes.find("POSITION");
            if (positions == primitive.attributes.end()) continue;
            const int index = primitive.indices >= 0 ? primitive.indices : positions->second;
            const std::size_t count = model.accessors[static_cast<std::size_t>(index)].count;
            // Strips and fans make up to three corners of one.
            corners += primitive.mode > TINYGLTF_MODE_TRIANGLES ? 3 * count : count;
            if (corners <= kMaxCorners) continue;
            gltf.fail(field,
                      fmt::format("{} corners of triangles up to here", corners),
                      fmt::format("at most {} in all uses of all meshes", kMaxCorners));
        }
    }
}

const std::string& first_of(const std::string& a, const std::string& b, const std::string& c) {
    return !a.empty() ? a : !b.empty() ? b : c;
}

std::vector<std::string> variant_names(const GltfFile& gltf) {
    std::vector<std::string> names;
    const auto extension = gltf.model.extensions.find(kVariantsExtension);
    if (extension == gltf.model.extensions.end()) return names;
    const auto& variants = extension->second.Get("variants").Get<tinygltf::Value::Array>();
    if (variants.size() > kMaxVariants) {
        gltf.fail(fmt::format("extensions.{}.variants", kVariantsExtension),
                  fmt::format("{} variants", variants.size()),
                  fmt::format("at most {}", kMaxVariants));
    }
    UniqueNames unique;
    for (std::size_t k = 0; k < variants.size(); ++k) {
        const std::string name = printable(variants[k].Get("name").Get<std::string>(), 60);
        names.push_back(unique.take(name.empty() ? fmt::format("variant {}", k) : name));
    }
    return names;
}

/// A part in another material. Its texture coordinates are those of its own: pictures along others
/// are left out.
Part in_variant(const GltfMaterial& own, const GltfMaterial& other, Notes& notes) {
    Part part = other.part;
    part.name = own.part.name;
    if (!part.pictures.empty() && !(own.uvs == other.uvs)) {
        part.pictures.clear();
        notes.push_back(
            fmt::format("part \"{}\": the pictures of {} lie along other texture coordinates; they "
                        "are not read",
                        part.name,
                        part.material_name));
    }
    return part;
}

}  // namespace

Mesh read_gltf(const std::string& bytes, const std::filesystem::path& file, Notes& notes) {
    const GltfFile gltf = open_gltf(bytes, file);
    const tinygltf::Model& model = gltf.model;
    note_unread(gltf, notes);
    const bool quantized = uses_extension(model, "KHR_mesh_quantization");
    GltfPictures pictures(gltf);
    std::vector<GltfMaterial> materials;
    for (std::size_t k = 0; k < model.materials.size(); ++k) {
        materials.push_back(read_gltf_material(gltf, pictures, k, notes));
    }

    const auto nodes = placed_nodes(gltf, notes);
    check_total_size(gltf, nodes);

    GltfAccessors accessors(gltf);
    UniqueNames names;
    Mesh mesh;
    std::vector<bool> said;  // of each vertex: its normal is the file's
    for (const std::string& name : variant_names(gltf)) mesh.variants.push_back({name, {}});
    for (const auto& [node_index, world_from_node] : nodes) {
        const tinygltf::Node& node = model.nodes[node_index];
        if (node.mesh < 0) continue;
        const tinygltf::Mesh& source = model.meshes[static_cast<std::size_t>(node.mesh)];
        const auto groups = group_by_material(gltf, node.mesh);
        const std::string node_name =
            first_of(node.name, source.name, fmt::format("node {}", node_index));
        for (const auto& group : groups) {
            GltfMaterial worn;
            if (group.material >= 0) worn = materials[static_cast<std::size_t>(group.material)];
            Part& part = worn.part;
            const std::string material = group.material >= 0 ? part.material_name : "no material";
            part.name = names.take(groups.size() > 1 ? node_name + "/" + material : node_name);
            Mesh built;
            for (const std::size_t k : group.primitives) {
                const GltfPrimitive primitive{
                    source.primitives[k],
                    fmt::format("meshes[{}].primitives[{}]", node.mesh, k),
                    quantized,
                    worn.uvs};
                append(
                    built,
                    build_primitive(gltf, accessors, primitive, world_from_node, part.name, notes),
                    "");
                said.resize(mesh.positions_mm.size() + built.positions_mm.size(),
                            primitive.content.attributes.contains("NORMAL"));
            }
            if (built.triangles.empty()) {
                notes.push_back(fmt::format("part \"{}\": nothing to show; dropped", part.name));
                continue;
            }
            if (mesh.parts.size() == 0xffff) {
                gltf.fail(
                    fmt::format("nodes[{}].mesh", node_index), "part 65536", "65535 parts or less");
            }
            built.parts = {part};
            append(mesh, built, "");
            for (const auto& [variant, other] : group.of_variant) {
                mesh.variants[static_cast<std::size_t>(variant)].parts[mesh.parts.size() - 1] =
                    in_variant(worn, materials[static_cast<std::size_t>(other)], notes);
            }
        }
    }
    if (!mesh.triangles.empty()) settle_sides(mesh, std::move(said), notes);
    if (mesh.triangles.empty()) {
        throw FileError(file, "meshes", "no triangles" + because(notes), "at least one");
    }
    return mesh;
}

namespace {

glm::dmat4 local_transform(const GltfFile& gltf, std::size_t index) {
    const tinygltf::Node& node = gltf.model.nodes[index];
    const std::string field = fmt::format("nodes[{}]", index);
    if (const auto& m = node.matrix; !m.empty()) {
        if (m[3] != 0.0 || m[7] != 0.0 || m[11] != 0.0 || m[15] != 1.0) {
            gltf.fail(field + ".matrix", "a projective matrix", "0, 0, 0, 1 as its last row");
        }
        return glm::make_mat4(m.data());
    }
    glm::dmat4 matrix(1.0);
    if (const auto& q = node.rotation; !q.empty()) {
        const glm::dquat rotation(q[3], q[0], q[1], q[2]);
        if (!(glm::length(rotation) > 1e-6)) {
            const auto said = gltf.root()["nodes"].at(index)["rotation"];
            said.fail(said.found(), "a unit quaternion");
        }
        matrix = glm::mat4_cast(glm::normalize(rotation));
    }
    for (std::size_t k = 0; k < node.scale.size(); ++k) {
        matrix[static_cast<int>(k)] *= node.scale[k];
    }
    if (const auto& t = node.translation; !t.empty()) {
        matrix[3] = glm::dvec4(t[0], t[1], t[2], 1.0);
    }
    return matrix;
}

bool is_hidden(const tinygltf::Node& node) {
    const auto visibility = node.extensions.find("KHR_node_visibility");
    return visibility != node.extensions.end() && visibility->second.Has("visible") &&
           !visibility->second.Get("visible").Get<bool>();
}

}  // namespace

std::vector<PlacedNode> placed_nodes(const GltfFile& gltf, std::vector<std::string>& notes) {
    const tinygltf::Model& model = gltf.model;
    std::vector<PlacedNode> pending;  // last in, first out: the order of the file is reversed
    const auto put = [&](const std::vector<int>& nodes, const glm::dmat4& world_from_parent) {
        for (std::size_t k = nodes.size(); k-- > 0;) {
            pending.push_back({static_cast<std::size_t>(nodes[k]), world_from_parent});
        }
    };
    if (!model.scenes.empty()) {
        put(model.scenes[static_cast<std::size_t>(std::max(model.defaultScene, 0))].nodes,
            glm::dmat4(1.0));
    } else {
        // Without scenes: every node that is nobody's child.
        std::vector<bool> is_child(model.nodes.size(), false);
        for (const auto& node : model.nodes) {
            for (const int child : node.children) is_child[static_cast<std::size_t>(child)] = true;
        }
        std::vector<int> roots;
        for (std::size_t n = 0; n < model.nodes.size(); ++n) {
            if (!is_child[n]) roots.push_back(static_cast<int>(n));
        }
        put(roots, glm::dmat4(1.0));
    }

    std::vector<PlacedNode> placed;
    std::vector<bool> seen(model.nodes.size(), false);
    while (!pending.empty()) {
        PlacedNode next = pending.back();
        pending.pop_back();
        const tinygltf::Node& node = model.nodes[next.index];
        if (seen[next.index]) {
            gltf.fail(fmt::format("nodes[{}]", next.index),
                      "a node reached twice (a cycle, or two parents)",
                      "a tree");
        }
        seen[next.index] = true;
        if (is_hidden(node)) {
            notes.push_back(fmt::format("nodes[{}] is not visible; dropped", next.index));
            continue;
        }
        next.world_from_node = next.world_from_node * local_transform(gltf, next.index);
        placed.push_back(next);
        put(node.children, next.world_from_node);
    }
    return placed;
}

}  // namespace livery
