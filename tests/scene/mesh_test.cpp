#include "scene/mesh.h"

#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace livery {
namespace {

double signed_volume(const Mesh& mesh) {
    double volume = 0.0;
    for (const auto& t : mesh.triangles) {
        const glm::dvec3 a(mesh.positions_mm[t.x]), b(mesh.positions_mm[t.y]),
            c(mesh.positions_mm[t.z]);
        volume += glm::dot(a, glm::cross(b, c)) / 6.0;
    }
    return volume;
}

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

}  // namespace
}  // namespace livery
