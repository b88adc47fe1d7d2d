// The geometry of light and the promises of a clean bench.
#include "twin/bench.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "small_bench.h"

namespace livery {
namespace {

using namespace livery::testing;

TEST(Bench, LightFallsWithCosineAndInverseSquareOnAWall) {
    BenchDescription description = wall_bench();
    const Bench bench(description, product_of(make_wall()));
    const ImageF xyz = bench.observe_xyz(filled(description, 255, 255, 255));
    const View& view = description.projector.view;
    // A wall of reflectance 1/2 at 500 mm: Y = 1/2 cos^3 (cosine, and inverse square as cos^2).
    // 16 samples over a pixel of .9 degrees at most: 1e-3 holds the curvature inside a pixel.
    for (int y = 4; y < 116; y += 9) {
        for (int x = 4; x < 156; x += 9) {
            const Ray ray = ray_through(view, {x + 0.5, y + 0.5});
            const double cosine = -ray.direction.z;
            EXPECT_NEAR(xyz.at(x, y, 1) / (0.5 * cosine * cosine * cosine), 1.0, 1e-3)
                << x << " " << y;
        }
    }
}

TEST(Bench, AWhiteDiffuserFacingTheProjectorHasLuminanceOne) {
    BenchDescription description = wall_bench();
    description.mockup.surfaces["*"].reflectance = flat(1.0);
    const Bench bench(description, product_of(make_wall()));
    const ImageF xyz = bench.observe_xyz(filled(description, 255, 255, 255));
    EXPECT_NEAR(xyz.at(80, 60, 1), 1.0, 1e-4);  // half a pixel off the axis: cos^3 differs by 1e-5
}

}  // namespace
}  // namespace livery
