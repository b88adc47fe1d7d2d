// Small meshes in which light has known answers.
#pragma once

#include <cmath>
#include <cstdint>

#include <glm/geometric.hpp>

#include "mesh/mesh.h"

namespace livery {

/// Appends a flat quad a, b, c, d, counter-clockwise seen from its outside.
inline void add_quad(Mesh& mesh, glm::vec3 a, glm::vec3 b, glm::vec3 c, glm::vec3 d) {
    const auto first = static_cast<std::uint32_t>(mesh.positions_mm.size());
    const glm::vec3 n = glm::normalize(glm::cross(b - a, c - a));
    for (const glm::vec3& p : {a, b, c, d}) {
        mesh.positions_mm.push_back(p);
        mesh.normals.push_back(n);
        mesh.tangents.emplace_back(glm::normalize(b - a), 1.0f);
        mesh.uvs.emplace_back(0.0f);
    }
    mesh.triangles.emplace_back(first, first + 1, first + 2);
    mesh.triangles.emplace_back(first, first + 2, first + 3);
    mesh.triangle_part.insert(mesh.triangle_part.end(), 2, 0);
    if (mesh.parts.empty()) mesh.parts.push_back({"part", "", glm::dvec3(0.5)});
}

/// A level square of half side `half_mm` at y = 0.
inline Mesh floor_mesh(float half_mm) {
    Mesh mesh;
    add_quad(mesh,
             {-half_mm, 0, half_mm},
             {half_mm, 0, half_mm},
             {half_mm, 0, -half_mm},
             {-half_mm, 0, -half_mm});
    return mesh;
}

/// Appends a closed box.
inline void add_box(Mesh& mesh, glm::vec3 low, glm::vec3 high) {
    const auto at = [&](int x, int y, int z) {
        return glm::vec3(x ? high.x : low.x, y ? high.y : low.y, z ? high.z : low.z);
    };
    add_quad(mesh, at(0, 1, 1), at(1, 1, 1), at(1, 1, 0), at(0, 1, 0));
    add_quad(mesh, at(0, 0, 0), at(1, 0, 0), at(1, 0, 1), at(0, 0, 1));
    add_quad(mesh, at(0, 0, 1), at(1, 0, 1), at(1, 1, 1), at(0, 1, 1));
    add_quad(mesh, at(1, 0, 1), at(1, 0, 0), at(1, 1, 0), at(1, 1, 1));
    add_quad(mesh, at(1, 0, 0), at(0, 0, 0), at(0, 1, 0), at(1, 1, 0));
    add_quad(mesh, at(0, 0, 0), at(0, 0, 1), at(0, 1, 1), at(0, 1, 0));
}

/// A box without its lid, inside outward: side 2, open above.
inline Mesh open_box() {
    Mesh mesh;
    add_quad(mesh, {-1, 0, 1}, {1, 0, 1}, {1, 0, -1}, {-1, 0, -1});
    add_quad(mesh, {-1, 0, -1}, {1, 0, -1}, {1, 2, -1}, {-1, 2, -1});
    add_quad(mesh, {1, 0, 1}, {-1, 0, 1}, {-1, 2, 1}, {1, 2, 1});
    add_quad(mesh, {-1, 0, 1}, {-1, 0, -1}, {-1, 2, -1}, {-1, 2, 1});
    add_quad(mesh, {1, 0, -1}, {1, 0, 1}, {1, 2, 1}, {1, 2, -1});
    return mesh;
}

/// A right-angled groove along z with its edge at the origin, sides of that width, open above.
inline Mesh groove(float side_mm, float length_mm) {
    Mesh mesh;
    const float a = side_mm * std::sqrt(0.5f), z = 0.5f * length_mm;
    add_quad(mesh, {0, 0, z}, {0, 0, -z}, {-a, a, -z}, {-a, a, z});
    add_quad(mesh, {0, 0, -z}, {0, 0, z}, {a, a, z}, {a, a, -z});
    // The sides face each other.
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const glm::vec3 n = mesh.normals[mesh.triangles[t].x];
        if (n.y > 0.0f) continue;
        std::swap(mesh.triangles[t].y, mesh.triangles[t].z);
    }
    for (glm::vec3& n : mesh.normals) n = n.y > 0.0f ? n : -n;
    return mesh;
}

}  // namespace livery
