// What holds for every mesh that was loaded.
#pragma once

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "mesh/mesh.h"

namespace livery {

inline double area_mm2(const Mesh& mesh) {
    double area = 0.0;
    for (const auto& t : mesh.triangles) {
        const glm::dvec3 a(mesh.positions_mm[t.x]), b(mesh.positions_mm[t.y]),
            c(mesh.positions_mm[t.z]);
        area += 0.5 * glm::length(glm::cross(b - a, c - a));
    }
    return area;
}

/// Of a closed surface whose triangles face outward it is positive.
inline double signed_volume(const Mesh& mesh) {
    double volume = 0.0;
    for (const auto& t : mesh.triangles) {
        const glm::dvec3 a(mesh.positions_mm[t.x]), b(mesh.positions_mm[t.y]),
            c(mesh.positions_mm[t.z]);
        volume += glm::dot(a, glm::cross(b, c)) / 6.0;
    }
    return volume;
}

/// Whether winding, normals and tangents agree at every corner of every triangle.
inline void expect_consistent(const Mesh& mesh) {
    ASSERT_EQ(mesh.normals.size(), mesh.positions_mm.size());
    ASSERT_EQ(mesh.tangents.size(), mesh.positions_mm.size());
    ASSERT_EQ(mesh.uvs.size(), mesh.positions_mm.size());
    ASSERT_EQ(mesh.triangle_part.size(), mesh.triangles.size());
    for (const auto& t : mesh.triangles) {
        const glm::vec3 a = mesh.positions_mm[t.x];
        const glm::vec3 across = glm::cross(mesh.positions_mm[t.y] - a, mesh.positions_mm[t.z] - a);
        for (int k = 0; k < 3; ++k) {
            const glm::vec3 n = mesh.normals[t[k]];
            EXPECT_GT(glm::dot(across, n), 0.0f);
            EXPECT_NEAR(glm::length(n), 1.0f, 1e-5f);
            EXPECT_NEAR(glm::length(glm::vec3(mesh.tangents[t[k]])), 1.0f, 1e-5f);
            EXPECT_NEAR(glm::dot(glm::vec3(mesh.tangents[t[k]]), n), 0.0f, 1e-5f);
        }
    }
}

}  // namespace livery
