#include <numbers>

#include <gtest/gtest.h>

#include "live/projector_setup.h"
#include "scene/library.h"
#include "studio/box_mesh.h"
#include "studio/product/product_answers.h"

namespace livery {
namespace {

View bench_projector() { return uncorrected_setup("default")->view; }

/// A thin board across the axis of a view whose picture begins at that axis.
TEST(LitShare, IsHalfOfWhatHalfLiesInThePicture) {
    View projector = look_at({0, 0, 1000}, {0, 0, 0}, 30.0 * std::numbers::pi / 180.0, 800, 800);
    const auto samples = mesh_samples(box({100, 100, 0.01f}));
    EXPECT_EQ(lit_share(samples, {}, projector), 1.0);
    projector.principal_px.x = 0.0;
    EXPECT_NEAR(lit_share(samples, {}, projector).value(), 0.5, 0.005);
    projector.principal_px.y = 0.0;
    EXPECT_NEAR(lit_share(samples, {}, projector).value(), 0.25, 0.005);
    projector.principal_px = {-400.0, -400.0};
    EXPECT_EQ(lit_share(samples, {}, projector), 0.0);
    EXPECT_FALSE(lit_share({}, {}, projector).has_value());
}

TEST(LitShare, FollowsUnitScaleAndPose) {
    const View projector = bench_projector();
    const auto samples = mesh_samples(box({0.16f, 0.05f, 0.07f}));
    ProductFile product;
    product.unit = LengthUnit::m;
    product.world_from_mesh = Rigid3{glm::dmat3(1.0), {0, 25, 0}};
    EXPECT_EQ(lit_share(samples, product, projector), 1.0);
    double before = 1.0;
    for (const double scale : {2.0, 4.0, 10.0}) {
        product.mesh_scale = scale;
        const double share = lit_share(samples, product, projector).value();
        EXPECT_LT(share, 0.8 * before) << scale;
        before = share;
    }
    product.mesh_scale = 1.0;
    product.world_from_mesh = Rigid3{glm::dmat3(1.0), {1000, 0, 0}};
    EXPECT_EQ(lit_share(samples, product, projector), 0.0);
}

TEST(LitShare, TheShippedCarIsLitAsAWhole) {
    const auto car = find_product("car");
    EXPECT_GT(lit_share(mesh_samples(car->mesh), {}, bench_projector()).value(), 0.995);
}

TEST(LitShare, SamplesLieEvenlyOnTheSurface) {
    // One face has 25 times the area of two others: many triangles or few make no difference.
    const auto samples = mesh_samples(box({100, 4, 100}), 5000);
    ASSERT_EQ(samples.size(), 5000u);
    int above = 0, on_rim = 0, left = 0;
    for (const MeshSample& sample : samples) {
        const bool level = std::abs(sample.normal.y) > 0.99f;
        above += level && sample.position.y > 0.0f;
        left += level && sample.position.x < -25.0f;
        on_rim += !level;
        EXPECT_NEAR(level ? std::abs(sample.position.y) : 2.0f, 2.0f, 1e-4);
    }
    EXPECT_NEAR(above, 5000 * 10000 / 21600, 10);
    EXPECT_NEAR(on_rim, 5000 * 1600 / 21600, 10);
    EXPECT_NEAR(left, 5000 * 5000 / 21600, 40);
    Mesh flat;
    flat.positions_mm = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
    flat.triangles = {{0, 1, 2}};
    EXPECT_TRUE(mesh_samples(flat).empty());
}

TEST(LitShare, IsSaidInASentence) {
    EXPECT_EQ(lit_share_text(0.999), "The simulated bench's projector lights all of it.");
    EXPECT_NE(lit_share_text(0.637).find("lights 63% of it."), std::string::npos);
}

}  // namespace
}  // namespace livery
