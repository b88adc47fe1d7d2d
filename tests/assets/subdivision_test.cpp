// The limit surface against what is known of Catmull-Clark surfaces.
#include "subdivision.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "car_cage.h"

namespace livery::assets {
namespace {

Cage cube() {
    Cage cage;
    for (int k = 0; k < 8; ++k) {
        cage.surface_points.emplace_back(k & 1 ? 1 : -1, k & 2 ? 1 : -1, k & 4 ? 1 : -1);
        cage.parameters.emplace_back(k, 0.0);
    }
    cage.faces = {{{0, 2, 3, 1}, 0},
                  {{4, 5, 7, 6}, 1},
                  {{0, 1, 5, 4}, 2},
                  {{2, 6, 7, 3}, 3},
                  {{0, 4, 6, 2}, 4},
                  {{1, 3, 7, 5}, 5}};
    return cage;
}

TEST(LimitSurface, CubeCornersGoToHalfTheirPlace) {
    // Valence n = 3: (n^2 v + 4 sum of edge neighbours + sum of face opposites) / (n (n + 5))
    // = (9 + 4 (3 - 2) + (-1)) / 24 a coordinate for a unit cube.
    const auto mesh = limit_surface(cube(), 2, 0);
    double farthest = 0.0;
    for (const auto& v : mesh.vertices) farthest = std::max(farthest, glm::length(v.position));
    EXPECT_NEAR(farthest, 0.5 * std::sqrt(3.0), 1e-9);
    EXPECT_EQ(mesh.quads.size(), 6u * 16u);
}

TEST(LimitSurface, NormalsPointOutOfTheCube) {
    for (const auto& v : limit_surface(cube(), 3, 0).vertices) {
        EXPECT_NEAR(glm::length(v.normal), 1.0, 1e-12);
        EXPECT_GT(glm::dot(v.normal, glm::normalize(v.position)), 0.9);
    }
}

TEST(LimitSurface, FittingPassesThroughTheSurfacePoints) {
    const auto loose = limit_surface(cube(), 1, 0), fitted = limit_surface(cube(), 1, 30);
    const auto farthest = [](const LimitMesh& mesh) {
        double most = 0.0;
        for (const auto& v : mesh.vertices) most = std::max(most, glm::length(v.position));
        return most;
    };
    EXPECT_LT(farthest(loose), 0.9);
    EXPECT_NEAR(farthest(fitted), std::sqrt(3.0), 1e-3);
}

TEST(CarCage, IsSymmetricAndEveryEdgeHasTwoFaces) {
    const auto cage = make_car_cage();
    std::map<std::pair<int, int>, int> uses;
    for (const auto& face : cage.faces) {
        for (int k = 0; k < 4; ++k) {
            ++uses[std::minmax(face.corners[k], face.corners[(k + 1) % 4])];
        }
    }
    for (const auto& [edge, count] : uses) ASSERT_EQ(count, 2);
    for (const auto& p : cage.surface_points) {
        bool found = false;
        for (const auto& q : cage.surface_points) {
            found = found || glm::distance(p * glm::dvec3(1, 1, -1), q) < 1e-12;
        }
        ASSERT_TRUE(found);
    }
}

TEST(CarSkin, HighlightsRunWithoutBreaks) {
    // Away from creases the normal turns little from one vertex to the next: 12 degrees over about
    // a millimetre is a radius of 5 mm, the tightest that the roof and the bonnet may have. At the
    // cowl they meet with a crease.
    const auto skin = limit_surface(make_car_cage(), 3, 2);
    std::size_t tested = 0, sharp = 0;
    for (const auto& quad : skin.quads) {
        if (quad.region != kTop) continue;
        const auto at = [&](int k) -> const LimitVertex& {
            return skin.vertices[static_cast<std::size_t>(quad.corners[k])];
        };
        const double station = at(0).parameters.x;
        if (std::abs(at(0).parameters.y) > 2.5 || station < 2.0 || station > 20.0 ||
            std::abs(station - kCowlStation) < 1.5) {
            continue;
        }
        ++tested;
        for (int k = 0; k < 4; ++k) {
            const double turn =
                std::acos(std::min(1.0, glm::dot(at(k).normal, at((k + 1) % 4).normal)));
            sharp += turn > 12.0 * 0.0174532925 ? 1 : 0;
        }
    }
    EXPECT_GT(tested, 1000u);
    EXPECT_EQ(sharp, 0u);
}

}  // namespace
}  // namespace livery::assets
