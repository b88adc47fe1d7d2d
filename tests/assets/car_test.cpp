// What the shipped car promises to everything that draws, lights or photographs it.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/paths.h"
#include "scene/product.h"

namespace livery {
namespace {

const Product& car() {
    static const Product product = load_product(shipped_path("assets/car.json"));
    return product;
}

struct Box {
    glm::dvec3 low{1e9}, high{-1e9};
};

/// Bounds of the vertices of a part for which `where` holds.
template <typename Where>
Box part_bounds(const std::string& part, Where&& where) {
    const auto& mesh = car().mesh;
    const int index = part_index(car(), part);
    Box box;
    for (std::size_t k = 0; k < mesh.triangles.size(); ++k) {
        if (mesh.triangle_part[k] != index) continue;
        for (int c = 0; c < 3; ++c) {
            const glm::dvec3 p = mesh.positions_mm[mesh.triangles[k][c]];
            if (!where(p)) continue;
            box.low = glm::min(box.low, p);
            box.high = glm::max(box.high, p);
        }
    }
    return box;
}
const auto kEverywhere = [](const glm::dvec3&) { return true; };

using Place = std::array<float, 3>;
Place place_of(const glm::vec3& p) {
    return {p.x, p.y, p.z == 0.0f ? 0.0f : p.z};  // -0 is 0
}

TEST(Car, IsAProductOfSixNamedPartsAtScale25) {
    EXPECT_EQ(car().name, "Car");
    EXPECT_EQ(car().product_scale, 25.0);
    EXPECT_TRUE(car().notes.empty()) << car().notes.front();
    std::set<std::string> names;
    for (const auto& part : car().mesh.parts) names.insert(part.name);
    EXPECT_EQ(names, (std::set<std::string>{"body", "glass", "rims", "tyres", "lights", "trim"}));
    EXPECT_EQ(car().mesh.parts.size(), names.size());
}

TEST(Car, HasItsSize) {
    const auto bounds = bounds_of(car().mesh);
    const glm::dvec3 size = bounds.high - bounds.low;
    EXPECT_NEAR(size.x, 180.0, 1.0);
    EXPECT_NEAR(size.y, 60.0, 1.0);
    EXPECT_NEAR(size.z, 79.6, 0.1);  // over the mirrors; 75 over the doors
    EXPECT_NEAR(bounds.low.y, 0.0, 0.01);
    EXPECT_NEAR(bounds.low.x + bounds.high.x, 0.0, 0.5);
    EXPECT_NEAR(bounds.low.z + bounds.high.z, 0.0, 1e-4);
}

TEST(Car, HasEnoughTrianglesForSmoothHighlightsAndNotMore) {
    EXPECT_GE(car().mesh.triangles.size(), 100'000u);
    EXPECT_LE(car().mesh.triangles.size(), 370'000u);
}

TEST(Car, HasUnitNormalsOnTheSideOfItsFaces) {
    const auto& mesh = car().mesh;
    for (const auto& n : mesh.normals) ASSERT_NEAR(glm::length(n), 1.0f, 1e-5f);
    std::size_t beyond_60_degrees = 0, opposite = 0;
    for (const auto& t : mesh.triangles) {
        const glm::dvec3 a = mesh.positions_mm[t.x], b = mesh.positions_mm[t.y];
        const glm::dvec3 c = mesh.positions_mm[t.z];
        const auto face = glm::normalize(glm::cross(b - a, c - a));
        double least = 1.0;
        for (int k = 0; k < 3; ++k) {
            least = std::min(least, glm::dot(face, glm::dvec3(mesh.normals[t[k]])));
        }
        beyond_60_degrees += least < 0.5 ? 1 : 0;
        opposite += least < -0.5 ? 1 : 0;
    }
    EXPECT_LE(beyond_60_degrees, mesh.triangles.size() / 1000);
    EXPECT_EQ(opposite, 0u);
}

TEST(Car, HasUnitTangentsAcrossTheNormalsAndFiniteUvs) {
    const auto& mesh = car().mesh;
    for (std::size_t k = 0; k < mesh.positions_mm.size(); ++k) {
        const glm::vec3 tangent(mesh.tangents[k]);
        ASSERT_NEAR(glm::length(tangent), 1.0f, 1e-5f);
        ASSERT_NEAR(glm::dot(tangent, mesh.normals[k]), 0.0f, 1e-5f);
        ASSERT_EQ(std::abs(mesh.tangents[k].w), 1.0f);
        ASSERT_TRUE(std::isfinite(mesh.uvs[k].x) && std::isfinite(mesh.uvs[k].y));
        ASSERT_LT(std::abs(mesh.uvs[k].x) + std::abs(mesh.uvs[k].y), 8.0f);
    }
}

TEST(Car, UvsKeepTheirScaleOverTheBody) {
    // The chart's unit is 180 mm. Where the skin is developed along its section (the sides, the
    // roof), lengths along u are true; a stretch of 2 either way covers the rounded ends.
    const auto& mesh = car().mesh;
    const int body = part_index(car(), "body");
    std::size_t tested = 0, stretched = 0;
    for (std::size_t k = 0; k < mesh.triangles.size(); ++k) {
        const auto& t = mesh.triangles[k];
        if (mesh.triangle_part[k] != body) continue;
        const glm::dvec3 a = mesh.positions_mm[t.x], b = mesh.positions_mm[t.y];
        const double length = glm::distance(a, b);
        if (length < 0.5) continue;
        const double charted =
            180.0 * glm::distance(glm::dvec2(mesh.uvs[t.x]), glm::dvec2(mesh.uvs[t.y]));
        ++tested;
        stretched += charted < length / 2.0 || charted > length * 2.0 ? 1 : 0;
    }
    EXPECT_GT(tested, 20'000u);
    EXPECT_LT(static_cast<double>(stretched), 0.10 * static_cast<double>(tested));
}

TEST(Car, IsSymmetric) {
    const auto& mesh = car().mesh;
    std::map<int, std::multiset<Place>> left, right;
    for (std::size_t k = 0; k < mesh.triangles.size(); ++k) {
        glm::vec3 centre(0.0f);
        std::array<Place, 3> corners{};
        for (int c = 0; c < 3; ++c) centre += mesh.positions_mm[mesh.triangles[k][c]];
        const bool is_left = centre.z > 0.0f;
        for (std::size_t c = 0; c < 3; ++c) {
            auto p = mesh.positions_mm[mesh.triangles[k][static_cast<int>(c)]];
            if (!is_left) p.z = -p.z;
            corners[c] = place_of(p);
        }
        std::sort(corners.begin(), corners.end());
        auto& side = (is_left ? left : right)[mesh.triangle_part[k]];
        for (const auto& corner : corners) side.insert(corner);
    }
    ASSERT_EQ(left.size(), 6u);
    EXPECT_EQ(left, right);
}

TEST(Car, StandsOnItsWheelsInsideTheArches) {
    const auto front = part_bounds("tyres", [](const glm::dvec3& p) { return p.x > 0 && p.z > 0; });
    const auto rear = part_bounds("tyres", [](const glm::dvec3& p) { return p.x < 0 && p.z > 0; });
    const auto body = part_bounds("body", kEverywhere);
    const double front_axle = 0.5 * (front.low.x + front.high.x);
    const double rear_axle = 0.5 * (rear.low.x + rear.high.x);
    // At full size: a wheelbase of 2.7 to 2.9 m, tyres of 700 to 740 mm.
    EXPECT_GE((front_axle - rear_axle) * 25.0, 2700.0);
    EXPECT_LE((front_axle - rear_axle) * 25.0, 2900.0);
    for (const auto& tyre : {front, rear}) {
        EXPECT_NEAR(tyre.low.y, 0.0, 1e-3);
        EXPECT_GE(tyre.high.y * 25.0, 700.0);
        EXPECT_LE(tyre.high.y * 25.0, 740.0);
        EXPECT_LT(tyre.high.z, body.high.z);
    }
    // Nothing of the body or the trim reaches into a tyre's cylinder, except what carries the
    // wheel.
    for (const auto& tyre : {front, rear}) {
        const glm::dvec3 centre = 0.5 * (tyre.low + tyre.high);
        const double radius = 0.5 * (tyre.high.y - tyre.low.y);
        const auto inside = [&](const glm::dvec3& p) {
            const double r = std::hypot(p.x - centre.x, p.y - centre.y);
            return r < radius + 0.5 && r > 9.7 && p.z > tyre.low.z && p.z < tyre.high.z;
        };
        for (const char* part : {"body", "trim", "lights", "glass"}) {
            EXPECT_GT(part_bounds(part, inside).low.x, 1e8) << part << " touches a tyre";
        }
    }
}

TEST(Car, HasGroundClearance) {
    for (const char* part : {"body", "trim"}) {
        EXPECT_GE(part_bounds(part, kEverywhere).low.y, 5.0) << part;
    }
}

TEST(Sphere, IsRoundAndSmooth) {
    const auto sphere = load_product(shipped_path("assets/sphere.json"));
    EXPECT_EQ(sphere.product_scale, 1.0);
    ASSERT_EQ(sphere.mesh.parts.size(), 1u);
    EXPECT_EQ(sphere.mesh.parts[0].name, "sphere");
    for (std::size_t k = 0; k < sphere.mesh.positions_mm.size(); ++k) {
        const auto& p = sphere.mesh.positions_mm[k];
        ASSERT_NEAR(glm::length(p), 25.0f, 1e-4f);
        ASSERT_NEAR(glm::dot(glm::normalize(p), sphere.mesh.normals[k]), 1.0f, 1e-6f);
    }
}

}  // namespace
}  // namespace livery
