// load_mesh: nodes, primitives and materials of a glTF file as one mesh in the world's frame.
#include <algorithm>
#include <cmath>
#include <set>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>

#include "core/error.h"
#include "scene/gltf_file.h"
#include "scene/mesh.h"

namespace livery {

namespace {

constexpr int kMaxInt = 0x7fffffff;
constexpr double kMmPerMetre = 1000.0;
/// A kilometre of kilometres: beyond, float coordinates are no longer a product.
constexpr double kFarthestMm = 1e9;
constexpr std::size_t kMaxVertices = 1u << 25u;

using Notes = std::vector<std::string>;

int index_into(const JsonReader& root, std::string_view array, const JsonReader& index) {
    const int count = root.has(array) ? static_cast<int>(root[array].size()) : 0;
    if (count == 0) index.fail(index.found(), "no index: there are no " + std::string(array));
    return index.integer(0, count - 1);
}

std::string name_or(const JsonReader& object, const std::string& otherwise) {
    if (!object.has("name")) return otherwise;
    const std::string name = object["name"].text();
    return name.empty() ? otherwise : name;
}

// ---- Nodes

glm::dmat4 local_transform(const JsonReader& node) {
    if (node.has("matrix")) {
        const auto m = node["matrix"].numbers(16);
        glm::dmat4 matrix;
        for (int k = 0; k < 16; ++k) matrix[k / 4][k % 4] = m[static_cast<std::size_t>(k)];
        if (m[3] != 0.0 || m[7] != 0.0 || m[11] != 0.0 || m[15] != 1.0) {
            node["matrix"].fail("a projective matrix", "0, 0, 0, 1 as its last row");
        }
        return matrix;
    }
    glm::dmat4 matrix(1.0);
    if (node.has("rotation")) {
        const auto q = node["rotation"].numbers(4);
        const glm::dquat rotation(q[3], q[0], q[1], q[2]);
        if (!(glm::length(rotation) > 1e-6)) {
            node["rotation"].fail(node["rotation"].found(), "a unit quaternion");
        }
        matrix = glm::mat4_cast(glm::normalize(rotation));
    }
    if (node.has("scale")) {
        const glm::dvec3 scale = node["scale"].vec3();
        for (int k = 0; k < 3; ++k) matrix[k] *= scale[k];
    }
    if (node.has("translation")) matrix[3] = glm::dvec4(node["translation"].vec3(), 1.0);
    return matrix;
}

struct PlacedNode {
    std::size_t index = 0;
    glm::dmat4 world_from_node{1.0};
};

/// The nodes of the shown scene. glTF's graph is a forest: a second way to a node is a mistake.
std::vector<PlacedNode> placed_nodes(const JsonReader& root) {
    const std::size_t count = root.has("nodes") ? root["nodes"].size() : 0;
    std::vector<PlacedNode> pending;
    if (root.has("scenes") && root["scenes"].size() > 0) {
        const int shown = root.has("scene") ? index_into(root, "scenes", root["scene"]) : 0;
        const auto scene = root["scenes"].at(static_cast<std::size_t>(shown));
        const std::size_t roots = scene.has("nodes") ? scene["nodes"].size() : 0;
        for (std::size_t k = roots; k-- > 0;) {
            const int index = index_into(root, "nodes", scene["nodes"].at(k));
            pending.push_back({static_cast<std::size_t>(index), glm::dmat4(1.0)});
        }
    } else {
        // Without scenes: every node that is nobody's child.
        std::vector<bool> is_child(count, false);
        for (std::size_t n = 0; n < count; ++n) {
            const auto node = root["nodes"].at(n);
            for (std::size_t c = 0; node.has("children") && c < node["children"].size(); ++c) {
                is_child[static_cast<std::size_t>(
                    index_into(root, "nodes", node["children"].at(c)))] = true;
            }
        }
        for (std::size_t n = count; n-- > 0;) {
            if (!is_child[n]) pending.push_back({n, glm::dmat4(1.0)});
        }
    }

    std::vector<PlacedNode> placed;
    std::vector<bool> seen(count, false);
    while (!pending.empty()) {
        PlacedNode next = pending.back();
        pending.pop_back();
        const auto node = root["nodes"].at(next.index);
        if (seen[next.index]) node.fail("a node reached twice (a cycle, or two parents)", "a tree");
        seen[next.index] = true;
        next.world_from_node = next.world_from_node * local_transform(node);
        placed.push_back(next);
        if (!node.has("children")) continue;
        for (std::size_t c = node["children"].size(); c-- > 0;) {
            const int child = index_into(root, "nodes", node["children"].at(c));
            pending.push_back({static_cast<std::size_t>(child), next.world_from_node});
        }
    }
    return placed;
}

// ---- Materials

Part read_material(const GltfFile& gltf, int index, Notes& notes) {
    Part part;
    const auto material = gltf.root()["materials"].at(static_cast<std::size_t>(index));
    part.material_name = name_or(material, fmt::format("material {}", index));
    if (!material.has("pbrMetallicRoughness")) return part;
    const auto pbr = material["pbrMetallicRoughness"];
    if (pbr.has("baseColorFactor")) {
        const auto factor = pbr["baseColorFactor"].numbers(4);
        for (std::size_t k = 0; k < 4; ++k) pbr["baseColorFactor"].at(k).number_between(0.0, 1.0);
        part.base_colour_rec709 = {factor[0], factor[1], factor[2]};
    } else if (!pbr.has("baseColorTexture")) {
        part.base_colour_rec709 = glm::dvec3(1.0);  // glTF's default
    }
    if (!pbr.has("baseColorTexture")) return part;

    // Pictures are not read: name the one that colours this material in other programs.
    const auto root = gltf.root();
    const int texture = index_into(root, "textures", pbr["baseColorTexture"]["index"]);
    const auto entry = root["textures"].at(static_cast<std::size_t>(texture));
    std::string picture = "an embedded picture";
    std::string state = "is not read";
    if (entry.has("source")) {
        const int source = index_into(root, "images", entry["source"]);
        const auto image = root["images"].at(static_cast<std::size_t>(source));
        if (image.has("uri") && !image["uri"].text().starts_with("data:")) {
            const std::string uri = image["uri"].text();
            picture = "the picture \"" + uri + "\"";
            std::error_code error;
            if (!std::filesystem::exists(gltf.path.parent_path() / uri, error))
                state = "is missing";
        }
    }
    notes.push_back(fmt::format(
        "material \"{}\": {} {}; its plain colour is shown", part.material_name, picture, state));
    return part;
}

// ---- Primitives

/// The triangles of a primitive as vertex indices, whatever its mode. Nothing for points and lines.
std::vector<glm::uvec3> read_triangles(GltfAccessors& accessors,
                                       const JsonReader& primitive,
                                       std::size_t vertex_count,
                                       const std::string& name,
                                       Notes& notes) {
    const int mode = integer_or(primitive, "mode", 0, 6, 4);
    if (mode < 4) {
        notes.push_back(
            fmt::format("part \"{}\": {} dropped", name, mode == 0 ? "points" : "lines"));
        return {};
    }
    std::vector<std::uint32_t> order;
    if (primitive.has("indices")) {
        const auto& numbers =
            accessors.read(primitive["indices"], {{"SCALAR"}, {5121, 5123, 5125}});
        order.reserve(numbers.values.size());
        for (const double index : numbers.values) {
            if (index >= static_cast<double>(vertex_count)) {
                primitive["indices"].fail(fmt::format("the vertex {:.0f}", index),
                                          fmt::format("indices below {}", vertex_count));
            }
            order.push_back(static_cast<std::uint32_t>(index));
        }
    } else {
        order.resize(vertex_count);
        for (std::size_t k = 0; k < vertex_count; ++k) order[k] = static_cast<std::uint32_t>(k);
    }
    if (order.size() < 3 || (mode == 4 && order.size() % 3 != 0)) {
        primitive.fail(fmt::format("{} corners", order.size()),
                       mode == 4 ? "a multiple of three" : "three or more");
    }
    std::vector<glm::uvec3> triangles;
    if (mode == 4) {
        for (std::size_t k = 0; k < order.size(); k += 3) {
            triangles.emplace_back(order[k], order[k + 1], order[k + 2]);
        }
        return triangles;
    }
    for (std::size_t k = 0; k + 2 < order.size(); ++k) {
        if (mode == 6) {
            triangles.emplace_back(order[0], order[k + 1], order[k + 2]);
        } else {  // every second triangle of a strip runs the other way
            triangles.emplace_back(order[k], order[k + 1 + k % 2], order[k + 2 - k % 2]);
        }
    }
    return triangles;
}

struct Attributes {
    const GltfNumbers* positions = nullptr;
    const GltfNumbers* normals = nullptr;
    const GltfNumbers* tangents = nullptr;
    const GltfNumbers* uvs = nullptr;
};

Attributes read_attributes(GltfAccessors& accessors, const JsonReader& primitive, bool quantized) {
    const auto attributes = primitive["attributes"];
    const auto types = [&](std::vector<int> always, std::vector<int> when_quantized) {
        if (quantized) always.insert(always.end(), when_quantized.begin(), when_quantized.end());
        return always;
    };
    Attributes found;
    found.positions = &accessors.read(attributes["POSITION"],
                                      {{"VEC3"}, types({5126}, {5120, 5121, 5122, 5123})});
    const auto optional = [&](std::string_view key, const GltfElementRule& rule) {
        if (!attributes.has(key)) return static_cast<const GltfNumbers*>(nullptr);
        const GltfNumbers* numbers = &accessors.read(attributes[key], rule);
        if (numbers->count() != found.positions->count()) {
            attributes[key].fail(fmt::format("{} elements", numbers->count()),
                                 fmt::format("{}, as many as positions", found.positions->count()));
        }
        return numbers;
    };
    found.normals = optional("NORMAL", {{"VEC3"}, types({5126}, {5120, 5122})});
    found.tangents = optional("TANGENT", {{"VEC4"}, types({5126}, {5120, 5122})});
    found.uvs = optional("TEXCOORD_0", {{"VEC2"}, types({5126, 5121, 5123}, {5120, 5122})});
    return found;
}

bool has_area(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
    const glm::dvec3 ab = b - a, ac = c - a, bc = c - b;
    const double longest = std::max({glm::dot(ab, ab), glm::dot(ac, ac), glm::dot(bc, bc)});
    // A needle a million times longer than wide is below the resolution of float coordinates.
    return glm::length(glm::cross(ab, ac)) > 1e-7 * longest;
}

/// Keeps the vertices that triangles use, in rising order, and renames them.
std::vector<std::uint32_t> compact(std::vector<glm::uvec3>& triangles) {
    std::vector<std::uint32_t> used;
    used.reserve(3 * triangles.size());
    for (const auto& triangle : triangles) used.insert(used.end(), &triangle.x, &triangle.x + 3);
    std::sort(used.begin(), used.end());
    used.erase(std::unique(used.begin(), used.end()), used.end());
    for (auto& triangle : triangles) {
        for (int k = 0; k < 3; ++k) {
            triangle[k] = static_cast<std::uint32_t>(
                std::lower_bound(used.begin(), used.end(), triangle[k]) - used.begin());
        }
    }
    return used;
}

/// Gives each triangle vertices of its own: glTF asks for flat shading where normals are missing.
std::vector<std::uint32_t> separate(std::vector<glm::uvec3>& triangles) {
    std::vector<std::uint32_t> used;
    used.reserve(3 * triangles.size());
    for (auto& triangle : triangles) {
        const auto first = static_cast<std::uint32_t>(used.size());
        used.insert(used.end(), &triangle.x, &triangle.x + 3);
        triangle = {first, first + 1, first + 2};
    }
    return used;
}

void fill_normals(Mesh& mesh,
                  const Attributes& from,
                  const std::vector<std::uint32_t>& used,
                  const glm::dmat3& linear,
                  const std::string& name,
                  Notes& notes) {
    compute_normals(mesh);
    if (!from.normals) {
        notes.push_back(fmt::format("part \"{}\": no normals; flat ones computed", name));
        return;
    }
    // Normals turn with the cofactors, which exist for flattened parts too.
    const glm::dmat3 cofactors(glm::cross(linear[1], linear[2]),
                               glm::cross(linear[2], linear[0]),
                               glm::cross(linear[0], linear[1]));
    const double side = glm::determinant(linear) < 0.0 ? -1.0 : 1.0;
    std::size_t repaired = 0;
    for (std::size_t v = 0; v < used.size(); ++v) {
        const double* n = from.normals->element(used[v]);
        const glm::dvec3 normal = side * (cofactors * glm::dvec3(n[0], n[1], n[2]));
        const double length = glm::length(normal);
        if (length > 0.0 && std::isfinite(length)) {
            mesh.normals[v] = glm::vec3(normal / length);
        } else {
            ++repaired;
        }
    }
    if (repaired > 0) {
        notes.push_back(
            fmt::format("part \"{}\": {} normals of no length computed anew", name, repaired));
    }
}

void fill_tangents(Mesh& mesh,
                   const Attributes& from,
                   const std::vector<std::uint32_t>& used,
                   const glm::dmat3& linear) {
    compute_tangents(mesh);
    if (!from.tangents || !from.normals) return;
    const double side = glm::determinant(linear) < 0.0 ? -1.0 : 1.0;
    for (std::size_t v = 0; v < used.size(); ++v) {
        const double* t = from.tangents->element(used[v]);
        const glm::dvec3 normal(mesh.normals[v]);
        glm::dvec3 along = linear * glm::dvec3(t[0], t[1], t[2]);
        const double before = glm::length(along);
        along -= normal * glm::dot(normal, along);
        const double length = glm::length(along);
        // Zero or along the normal: the computed one stands.
        if (!(length > 1e-4 * before) || !std::isfinite(length)) continue;
        mesh.tangents[v] = glm::vec4(glm::vec3(along / length), side * t[3] < 0.0 ? -1.0f : 1.0f);
    }
}

/// One primitive in world coordinates, as a mesh of one part. Empty when nothing of it is left.
Mesh build_primitive(GltfAccessors& accessors,
                     const JsonReader& primitive,
                     const glm::dmat4& world_from_node,
                     bool quantized,
                     Part part,
                     Notes& notes) {
    const Attributes from = read_attributes(accessors, primitive, quantized);
    const std::size_t vertex_count = from.positions->count();
    auto triangles = read_triangles(accessors, primitive, vertex_count, part.name, notes);

    const glm::dmat3 linear(world_from_node);
    const auto world_mm = [&](std::uint32_t vertex) {
        const double* p = from.positions->element(vertex);
        return kMmPerMetre * glm::dvec3(world_from_node * glm::dvec4(p[0], p[1], p[2], 1.0));
    };
    const std::size_t before = triangles.size();
    std::erase_if(triangles, [&](const glm::uvec3& t) {
        return !has_area(world_mm(t.x), world_mm(t.y), world_mm(t.z));
    });
    if (const std::size_t dropped = before - triangles.size(); dropped > 0) {
        notes.push_back(
            fmt::format("part \"{}\": {} triangles without area dropped", part.name, dropped));
    }
    if (glm::determinant(linear) < 0.0) {
        for (auto& triangle : triangles) std::swap(triangle.y, triangle.z);
    }

    const auto used = from.normals ? compact(triangles) : separate(triangles);
    Mesh mesh;
    mesh.triangles = std::move(triangles);
    for (const auto vertex : used) {
        const glm::dvec3 position = world_mm(vertex);
        if (!(glm::length(position) < kFarthestMm)) {
            primitive["attributes"]["POSITION"].fail(
                fmt::format("a vertex {:g} mm away", glm::length(position)),
                fmt::format("positions within {:g} mm", kFarthestMm));
        }
        mesh.positions_mm.emplace_back(position);
        const double* uv = from.uvs ? from.uvs->element(vertex) : nullptr;
        mesh.uvs.push_back(uv ? glm::vec2(uv[0], uv[1]) : glm::vec2(0.0f));
    }
    fill_normals(mesh, from, used, linear, part.name, notes);
    fill_tangents(mesh, from, used, linear);
    mesh.triangle_part.assign(mesh.triangles.size(), 0);
    mesh.parts.push_back(std::move(part));
    return mesh;
}

// ---- The whole

std::string unique_name(const std::string& wanted, std::set<std::string>& taken) {
    std::string name = wanted;
    for (int k = 2; !taken.insert(name).second; ++k) name = fmt::format("{}-{}", wanted, k);
    return name;
}

/// One mesh a material, in the order in which the node's primitives name them.
std::vector<std::pair<int, std::vector<std::size_t>>> group_by_material(const JsonReader& root,
                                                                        const JsonReader& mesh) {
    std::vector<std::pair<int, std::vector<std::size_t>>> groups;
    for (std::size_t k = 0; k < mesh["primitives"].size(); ++k) {
        const auto primitive = mesh["primitives"].at(k);
        const int material =
            primitive.has("material") ? index_into(root, "materials", primitive["material"]) : -1;
        auto group = std::find_if(
            groups.begin(), groups.end(), [&](const auto& g) { return g.first == material; });
        if (group == groups.end()) group = groups.insert(group, {material, {}});
        group->second.push_back(k);
    }
    return groups;
}

void note_unread(const JsonReader& root, Notes& notes) {
    if (root.has("extensionsUsed")) {
        for (std::size_t k = 0; k < root["extensionsUsed"].size(); ++k) {
            const std::string name = root["extensionsUsed"].at(k).text();
            if (name != "KHR_mesh_quantization") notes.push_back(name + " is not read");
        }
    }
    for (const char* feature : {"skins", "animations"}) {
        if (root.has(feature)) {
            notes.push_back(fmt::format("{} are not read; the mesh is shown at rest", feature));
        }
    }
}

}  // namespace

Mesh load_mesh(const std::filesystem::path& file, std::vector<std::string>* notes_or_null) {
    const GltfFile gltf = open_gltf(file);
    const auto root = gltf.root();
    Notes notes;
    note_unread(root, notes);
    bool quantized = false;
    for (std::size_t k = 0; root.has("extensionsUsed") && k < root["extensionsUsed"].size(); ++k) {
        quantized |= root["extensionsUsed"].at(k).text() == "KHR_mesh_quantization";
    }

    std::vector<Part> materials;
    const std::size_t material_count = root.has("materials") ? root["materials"].size() : 0;
    for (std::size_t k = 0; k < material_count; ++k) {
        materials.push_back(read_material(gltf, static_cast<int>(k), notes));
    }

    GltfAccessors accessors(gltf);
    std::set<std::string> taken;
    Mesh mesh;
    for (const auto& [node_index, world_from_node] : placed_nodes(root)) {
        const auto node = root["nodes"].at(node_index);
        if (!node.has("mesh")) continue;
        const int mesh_index = index_into(root, "meshes", node["mesh"]);
        const auto source = root["meshes"].at(static_cast<std::size_t>(mesh_index));
        const std::string node_name =
            name_or(node, name_or(source, fmt::format("node {}", node_index)));
        const auto groups = group_by_material(root, source);
        for (const auto& [material, primitives] : groups) {
            Part part;
            if (material >= 0) part = materials[static_cast<std::size_t>(material)];
            std::string name = node_name;
            if (groups.size() > 1)
                name += "/" + (material < 0 ? "no material" : part.material_name);
            part.name = unique_name(name, taken);
            Mesh built;
            for (const std::size_t k : primitives) {
                const Mesh piece = build_primitive(
                    accessors, source["primitives"].at(k), world_from_node, quantized, part, notes);
                append(built, piece, "");
            }
            if (built.triangles.empty()) {
                notes.push_back(fmt::format("part \"{}\": nothing to show; dropped", part.name));
                continue;
            }
            built.parts.resize(1);
            built.triangle_part.assign(built.triangles.size(), 0);
            if (mesh.positions_mm.size() + built.positions_mm.size() > kMaxVertices ||
                mesh.parts.size() == 0xffff) {
                node["mesh"].fail("too much in all its uses",
                                  fmt::format("at most {} vertices and 65535 parts", kMaxVertices));
            }
            append(mesh, built, "");
        }
    }
    if (mesh.triangles.empty()) throw FileError(file, "", "no triangles", "at least one");
    if (notes_or_null) {
        notes_or_null->insert(notes_or_null->end(), notes.begin(), notes.end());
    }
    return mesh;
}

}  // namespace livery
