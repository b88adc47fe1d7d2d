// What holds for every mesh that a file became.
#pragma once

#include <cmath>

#include <glm/geometric.hpp>

#include "fuzz/fuzz.h"
#include "mesh/mesh.h"

namespace livery::fuzz {

inline void require_sound(const Mesh& mesh) {
    const std::size_t vertices = mesh.positions_mm.size();
    require(mesh.normals.size() == vertices && mesh.tangents.size() == vertices &&
                mesh.uvs.size() == vertices,
            "vertex arrays are equally long");
    require(!mesh.triangles.empty() && mesh.triangle_part.size() == mesh.triangles.size(),
            "a part for each triangle");
    for (const auto& t : mesh.triangles) {
        require(t.x < vertices && t.y < vertices && t.z < vertices, "indices are in range");
    }
    for (const auto part : mesh.triangle_part) require(part < mesh.parts.size(), "a known part");
    for (const Part& part : mesh.parts) require(part.name == printable(part.name), "shown names");
    for (std::size_t v = 0; v < vertices; ++v) {
        require(std::isfinite(glm::length(mesh.positions_mm[v])), "positions are finite");
        require(std::abs(glm::length(mesh.normals[v]) - 1.0f) < 1e-3f, "normals are unit");
        const glm::vec3 tangent(mesh.tangents[v]);
        require(std::abs(glm::length(tangent) - 1.0f) < 1e-3f, "tangents are unit");
        require(std::abs(glm::dot(tangent, mesh.normals[v])) < 1e-3f, "tangents lie flat");
        require(std::isfinite(mesh.uvs[v].x) && std::isfinite(mesh.uvs[v].y), "uvs are finite");
    }
}

inline void read_soundly(const std::string& bytes, const char* name) {
    std::vector<std::string> notes;
    require_sound(read_mesh(bytes, name, &notes));
    for (const std::string& note : notes) require(note == printable(note), "notes can be shown");
}

}  // namespace livery::fuzz
