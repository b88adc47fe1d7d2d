// The nearest of many points, against all of them looked at.
#include <algorithm>
#include <limits>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "calibration/registration/surface_samples.h"
#include "core/random.h"

namespace livery {
namespace {

TEST(NearestSample, IsTheOneThatLookingAtAllFinds) {
    Random random(3);
    const auto anywhere = [&] {
        return glm::dvec3(random.uniform(), random.uniform(), random.uniform()) * 100.0;
    };
    std::vector<glm::dvec3> points(500);
    for (glm::dvec3& point : points) point = anywhere();
    const NearestSample tree(points);
    constexpr double kMost_mm = 6.0;
    int none = 0;
    for (int k = 0; k < 500; ++k) {
        const glm::dvec3 place = anywhere();
        double least = std::numeric_limits<double>::infinity();
        for (const glm::dvec3& point : points) least = std::min(least, glm::distance(point, place));
        const auto found = tree.of(place, kMost_mm);
        ASSERT_EQ(found.has_value(), least < kMost_mm) << least;
        none += !found;
        if (!found) continue;
        EXPECT_EQ(glm::distance(points[*found], place), least);
    }
    EXPECT_GT(none, 50) << "some are too far from every point";
    EXPECT_LT(none, 450);
}

TEST(NearestSample, OfNoPointsIsNone) {
    EXPECT_EQ(NearestSample({}).of({1.0, 2.0, 3.0}, 1e9), std::nullopt);
}

TEST(NearestSample, OfPointsInOnePlaceIsOneOfThem) {
    const NearestSample tree(std::vector<glm::dvec3>(100, glm::dvec3(5.0)));
    EXPECT_TRUE(tree.of({5.0, 5.0, 6.0}, 2.0));
    EXPECT_FALSE(tree.of({5.0, 5.0, 8.0}, 2.0));
}

}  // namespace
}  // namespace livery
