#include "scene/view.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

namespace livery {
namespace {

TEST(LookAt, PutsTheTargetInTheMiddleAndUpIsUp) {
    const View view = look_at({100.0, 200.0, 300.0}, {1.0, 2.0, 3.0}, 0.5, 640, 480);
    const auto middle = project(view, {1.0, 2.0, 3.0});
    ASSERT_TRUE(middle);
    EXPECT_NEAR(middle->x, 320.0, 1e-9);
    EXPECT_NEAR(middle->y, 240.0, 1e-9);
    const auto above = project(view, {1.0, 12.0, 3.0});
    ASSERT_TRUE(above);
    EXPECT_LT(above->y, 240.0);
    EXPECT_NEAR(glm::distance(centre_in_world(view), {100.0, 200.0, 300.0}), 0.0, 1e-9);
    EXPECT_FALSE(project(view, {200.0, 400.0, 600.0}));
}

}  // namespace
}  // namespace livery
