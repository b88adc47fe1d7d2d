#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "mesh/gltf_parts.h"
#include "mesh/surface.h"

namespace livery {

namespace {

constexpr double kMmPerMetre = 1000.0;
/// A thousand kilometres: beyond, float coordinates are no longer a product.
constexpr double kFarthestMm = 1e9;

using Notes = std::vector<std::string>;

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

}  // namespace

Mesh build_primitive(GltfAccessors& accessors,
                     const JsonReader& primitive,
                     const glm::dmat4& world_from_node,
                     bool quantized,
                     const std::string& part_name,
                     Notes& notes) {
    const Attributes from = read_attributes(accessors, primitive, quantized);
    const std::size_t vertex_count = from.positions->count();
    if (primitive.has("targets")) {
        notes.push_back(fmt::format("part \"{}\": morph targets are not read", part_name));
    }
    auto triangles = read_triangles(accessors, primitive, vertex_count, part_name, notes);

    const glm::dmat3 linear(world_from_node);
    const auto world_mm = [&](std::uint32_t vertex) {
        const double* p = from.positions->element(vertex);
        const glm::dvec3 position =
            kMmPerMetre * glm::dvec3(world_from_node * glm::dvec4(p[0], p[1], p[2], 1.0));
        if (!(glm::length(position) < kFarthestMm)) {
            primitive["attributes"]["POSITION"].fail(
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
        mesh.uvs.push_back(uv ? glm::vec2(uv[0], uv[1]) : glm::vec2(0.0f));
    }
    fill_normals(mesh, from, used, linear, part_name, notes);
    fill_tangents(mesh, from, used, linear);
    mesh.triangle_part.assign(mesh.triangles.size(), 0);
    return mesh;
}

}  // namespace livery
