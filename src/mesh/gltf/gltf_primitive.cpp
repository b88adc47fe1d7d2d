#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "mesh/gltf/gltf_parts.h"
#include "mesh/surface.h"

namespace livery {

namespace {

constexpr double kMmPerMetre = 1000.0;
/// A thousand kilometres: beyond, float coordinates are no longer a product.

using Notes = std::vector<std::string>;

/// The triangles of a primitive as vertex indices, whatever its mode. Nothing for points and lines.
std::vector<glm::uvec3> read_triangles(const GltfFile& gltf,
                                       GltfAccessors& accessors,
                                       const GltfPrimitive& primitive,
                                       std::size_t vertex_count,
                                       const std::string& name,
                                       Notes& notes) {
    const int mode = primitive.content.mode;
    if (mode < TINYGLTF_MODE_TRIANGLES) {
        notes.push_back(
            fmt::format("part \"{}\": {} dropped", name, mode == 0 ? "points" : "lines"));
        return {};
    }
    std::vector<std::uint32_t> order;
    if (primitive.content.indices >= 0) {
        const auto& numbers =
            accessors.read(primitive.content.indices, {{TINYGLTF_TYPE_SCALAR}, {5121, 5123, 5125}});
        order.reserve(numbers.values.size());
        for (const double index : numbers.values) {
            if (index >= static_cast<double>(vertex_count)) {
                gltf.fail(primitive.field + ".indices",
                          fmt::format("the vertex {:.0f}", index),
                          fmt::format("indices below {}", vertex_count));
            }
            order.push_back(static_cast<std::uint32_t>(index));
        }
    } else {
        order.resize(vertex_count);
        for (std::size_t k = 0; k < vertex_count; ++k) order[k] = static_cast<std::uint32_t>(k);
    }
    if (order.size() < 3 || (mode == 4 && order.size() % 3 != 0)) {
        gltf.fail(primitive.field,
                  fmt::format("{} corners", order.size()),
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

Attributes read_attributes(const GltfFile& gltf,
                           GltfAccessors& accessors,
                           const GltfPrimitive& primitive) {
    const auto& attributes = primitive.content.attributes;
    Attributes found;
    const auto read = [&](const char* key,
                          int type,
                          std::vector<int> component_types,
                          const std::vector<int>& when_quantized) {
        const auto index = attributes.find(key);
        if (index == attributes.end()) return static_cast<const GltfNumbers*>(nullptr);
        if (primitive.quantized) {
            component_types.insert(
                component_types.end(), when_quantized.begin(), when_quantized.end());
        }
        const GltfNumbers* numbers = &accessors.read(index->second, {{type}, component_types});
        if (found.positions && numbers->count() != found.positions->count()) {
            gltf.fail(primitive.field + ".attributes." + key,
                      fmt::format("{} elements", numbers->count()),
                      fmt::format("{}, as many as positions", found.positions->count()));
        }
        return numbers;
    };
    found.positions = read("POSITION", TINYGLTF_TYPE_VEC3, {5126}, {5120, 5121, 5122, 5123});
    if (!found.positions) return found;
    found.normals = read("NORMAL", TINYGLTF_TYPE_VEC3, {5126}, {5120, 5122});
    found.tangents = read("TANGENT", TINYGLTF_TYPE_VEC4, {5126}, {5120, 5122});
    const std::string uvs = fmt::format("TEXCOORD_{}", primitive.uvs.set);
    found.uvs = read(uvs.c_str(), TINYGLTF_TYPE_VEC2, {5126, 5121, 5123}, {5120, 5122});
    return found;
}

/// A compressed primitive may have its numbers a second time, for those who do not unpack it.
void check_compression(const GltfFile& gltf, const GltfPrimitive& primitive) {
    const char* const draco = "KHR_draco_mesh_compression";
    if (!primitive.content.extensions.contains(draco)) return;
    for (const auto& [name, index] : primitive.content.attributes) {
        if (gltf.has_view(gltf.model.accessors[static_cast<std::size_t>(index)])) continue;
        gltf.fail(primitive.field + ".extensions." + draco,
                  name + " compressed by Draco alone",
                  "a mesh without it (export without compression)");
    }
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
                   const glm::dmat3& linear,
                   bool of_these_uvs) {
    compute_tangents(mesh);
    if (!from.tangents || !from.normals || !of_these_uvs) return;
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

}  // namespace

Mesh build_primitive(const GltfFile& gltf,
                     GltfAccessors& accessors,
                     const GltfPrimitive& primitive,
                     const glm::dmat4& world_from_node,
                     const std::string& part_name,
                     Notes& notes) {
    check_compression(gltf, primitive);
    const Attributes from = read_attributes(gltf, accessors, primitive);
    if (!from.positions) {
        notes.push_back(fmt::format("{}.attributes has no POSITION; dropped", primitive.field));
        return {};
    }
    const std::size_t vertex_count = from.positions->count();
    if (primitive.content.attributes.contains("COLOR_0")) {
        notes.push_back(fmt::format("part \"{}\": colours of vertices are not read", part_name));
    }
    if (!primitive.content.targets.empty()) {
        notes.push_back(fmt::format("part \"{}\": morph targets are not read", part_name));
    }
    auto triangles = read_triangles(gltf, accessors, primitive, vertex_count, part_name, notes);

    const glm::dmat3 linear(world_from_node);
    const auto world_mm = [&](std::uint32_t vertex) {
        const double* p = from.positions->element(vertex);
        const glm::dvec3 position =
            kMmPerMetre * glm::dvec3(world_from_node * glm::dvec4(p[0], p[1], p[2], 1.0));
        if (!(glm::length(position) < kFarthestMm)) {
            gltf.fail(primitive.field + ".attributes.POSITION",
                      fmt::format("a vertex {:g} mm away", glm::length(position)),
                      fmt::format("positions within {:g} mm", kFarthestMm));
        }
        return position;
    };
    const std::size_t before = triangles.size();
    std::erase_if(triangles, [&](const glm::uvec3& t) {
        return !has_area(world_mm(t.x), world_mm(t.y), world_mm(t.z));
    });
    if (const std::size_t dropped = before - triangles.size(); dropped > 0) {
        notes.push_back(
            fmt::format("part \"{}\": {} triangles without area dropped", part_name, dropped));
    }
    if (glm::determinant(linear) < 0.0) {
        for (auto& triangle : triangles) std::swap(triangle.y, triangle.z);
    }

    const auto used = from.normals ? compact(triangles) : separate(triangles);
    Mesh mesh;
    mesh.triangles = std::move(triangles);
    for (const auto vertex : used) {
        mesh.positions_mm.emplace_back(world_mm(vertex));
        const double* uv = from.uvs ? from.uvs->element(vertex) : nullptr;
        mesh.uvs.push_back(
            uv ? glm::vec2(primitive.uvs.picture_from_uv * glm::dvec3(uv[0], uv[1], 1.0))
               : glm::vec2(0.0f));
    }
    fill_normals(mesh, from, used, linear, part_name, notes);
    fill_tangents(mesh, from, used, linear, primitive.uvs == GltfUvs());
    mesh.triangle_part.assign(mesh.triangles.size(), 0);
    return mesh;
}

}  // namespace livery
