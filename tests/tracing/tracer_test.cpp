#include "tracing/tracer.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

namespace livery {
namespace {

TEST(Tracer, HitsASphereWhereItIs) {
    const Mesh sphere = make_sphere({0.0, 0.0, 0.0}, 50.0, 128, "ball");
    const Tracer tracer(sphere);
    const Hit hit = tracer.closest({{3.0f, 4.0f, 200.0f}, 0.0f, {0.0f, 0.0f, -1.0f}, 1e30f});
    ASSERT_TRUE(hit.valid());
    EXPECT_NEAR(hit.t, 200.0 - std::sqrt(2500.0 - 25.0), 0.02);
    const SurfacePoint point = surface_point(sphere, hit);
    EXPECT_NEAR(glm::distance(point.position_mm, glm::vec3(3.0f, 4.0f, 200.0f - hit.t)), 0.0, 1e-4);
    EXPECT_GT(glm::dot(point.geometric_normal, glm::vec3(0, 0, 1)), 0.9f);
    EXPECT_FALSE(tracer.closest({{60.0f, 0.0f, 200.0f}, 0.0f, {0.0f, 0.0f, -1.0f}, 1e30f}).valid());
    EXPECT_TRUE(tracer.occluded({{0.0f, 0.0f, 200.0f}, 0.0f, {0.0f, 0.0f, -1.0f}, 1e30f}));
    EXPECT_FALSE(tracer.occluded({{0.0f, 0.0f, 200.0f}, 0.0f, {0.0f, 0.0f, -1.0f}, 100.0f}));
}

}  // namespace
}  // namespace livery
