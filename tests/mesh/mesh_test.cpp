#include "mesh/mesh.h"

#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "mesh/mesh_checks.h"

namespace livery {
namespace {

TEST(Sphere, HasItsVolumeAndTrianglesFaceOutward) {
    const Mesh sphere = make_sphere({3.0, -2.0, 5.0}, 40.0, 64, "ball");
    // A polyhedron with N rings inscribed in a sphere lacks about (pi/N)^2/2 of the volume: 0.12%.
    const double ideal = 4.0 / 3.0 * std::numbers::pi * 40.0 * 40.0 * 40.0;
    EXPECT_NEAR(signed_volume(sphere) / ideal, 1.0, 0.0025);
    EXPECT_EQ(sphere.triangles.size(), 2u * 64u * 128u - 2u * 128u);
    EXPECT_EQ(sphere.parts.at(0).name, "ball");
    const Bounds bounds = bounds_of(sphere);
    EXPECT_NEAR(bounds.low.x, -37.0, 1e-4);
    EXPECT_NEAR(bounds.high.y, 38.0, 1e-4);
}

TEST(Sphere, CarriesExactNormalsTangentsAndUvs) {
    const glm::vec3 centre(3.0f, -2.0f, 5.0f);
    const Mesh sphere = make_sphere(centre, 40.0, 16, "ball");
    for (std::size_t k = 0; k < sphere.positions_mm.size(); ++k) {
        const glm::vec3 outward = (sphere.positions_mm[k] - centre) / 40.0f;
        EXPECT_LT(glm::distance(sphere.normals[k], outward), 1e-6f);
        EXPECT_NEAR(glm::dot(glm::vec3(sphere.tangents[k]), outward), 0.0f, 1e-6f);
        // The bitangent points up the picture, to where v falls: to the north.
        const glm::vec3 up =
            glm::cross(sphere.normals[k], glm::vec3(sphere.tangents[k])) * sphere.tangents[k].w;
        if (std::abs(outward.y) < 0.99f) {
            EXPECT_GT(up.y, 0.0f);
        }
        EXPECT_NEAR(std::cos(std::numbers::pi * sphere.uvs[k].y), outward.y, 1e-6);
    }
    EXPECT_THROW(make_sphere({}, 0.0, 16, ""), std::invalid_argument);
    EXPECT_THROW(make_sphere({}, 1.0, 1, ""), std::invalid_argument);
}

TEST(ComputedNormals, OfASphereAreItsRadii) {
    Mesh sphere = make_sphere({0, 0, 0}, 40.0, 64, "ball");
    const auto exact = sphere.normals;
    compute_normals(sphere);
    const std::size_t row = 2 * 64 + 1;
    for (std::size_t k = 0; k < exact.size(); ++k) {
        if (std::abs(exact[k].y) > 0.999f) continue;
        // At the seam a vertex owns one side only and leans by half a quad (1.4 degrees).
        const bool at_seam = k % row == 0 || k % row == row - 1;
        EXPECT_GT(glm::dot(exact[k], sphere.normals[k]), at_seam ? 0.9995f : 0.99995f);
    }
}

TEST(ComputedNormals, AreWeightedByArea) {
    // At the origin meet a triangle of area 3/2 that faces +z and one of area 1/2 that faces +x.
    Mesh mesh;
    mesh.positions_mm = {{0, 0, 0}, {3, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    compute_normals(mesh);
    EXPECT_LT(glm::distance(mesh.normals[0], glm::normalize(glm::vec3(1, 0, 3))), 1e-6f);
}

TEST(ComputedNormals, ExistWhereNothingIsThere) {
    Mesh mesh;
    mesh.positions_mm = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {9, 9, 9}};
    mesh.triangles = {{0, 1, 2}, {0, 2, 1}};  // two sheets back to back, and a vertex alone
    compute_normals(mesh);
    for (const auto& normal : mesh.normals) EXPECT_NEAR(glm::length(normal), 1.0f, 1e-6f);
    compute_tangents(mesh);
    for (std::size_t k = 0; k < mesh.tangents.size(); ++k) {
        const glm::vec3 tangent(mesh.tangents[k]);
        EXPECT_NEAR(glm::length(tangent), 1.0f, 1e-6f);
        EXPECT_NEAR(glm::dot(tangent, mesh.normals[k]), 0.0f, 1e-6f);
    }
}

TEST(ComputedTangents, FollowTheUvsOfASphere) {
    Mesh sphere = make_sphere({0, 0, 0}, 40.0, 64, "ball");
    const auto exact = sphere.tangents;
    compute_tangents(sphere);
    for (std::size_t k = 0; k < exact.size(); ++k) {
        if (std::abs(sphere.normals[k].y) > 0.99f) continue;
        EXPECT_GT(glm::dot(glm::vec3(exact[k]), glm::vec3(sphere.tangents[k])), 0.999f);
        EXPECT_EQ(sphere.tangents[k].w, exact[k].w);
    }
    Mesh without_normals = sphere;
    without_normals.normals.clear();
    EXPECT_THROW(compute_tangents(without_normals), std::invalid_argument);
}

TEST(Append, KeepsBothAndPrefixesNames) {
    Mesh mesh = make_sphere({0, 0, 0}, 10.0, 8, "one");
    const std::size_t triangles = mesh.triangles.size();
    append(mesh, make_sphere({100, 0, 0}, 20.0, 8, "two"), "right ");
    ASSERT_EQ(mesh.triangles.size(), 2 * triangles);
    EXPECT_EQ(mesh.parts[1].name, "right two");
    EXPECT_EQ(mesh.triangle_part.back(), 1);
    EXPECT_EQ(bounds_of(mesh).high.x, 120.0);
    EXPECT_NEAR(mesh.positions_mm[mesh.triangles.back().x].x, 100.0f, 20.0f);
    EXPECT_EQ(bounds_of(Mesh{}).high, glm::dvec3(0.0));

    Mesh many;
    many.parts.resize(65535);
    EXPECT_THROW(append(mesh, many, ""), std::invalid_argument) << "more parts than 16 bits name";
}

}  // namespace
}  // namespace livery
