#include "scene/mockup_mask.h"

#include <stdexcept>

#include <gtest/gtest.h>

namespace livery {
namespace {

TEST(MockupMask, HoldsThePixelsWhoseCentresLookAtTheMesh) {
    Mesh mesh = make_sphere({20, 0, 0}, 40.0, 48, "ball");
    View view = look_at({0, 0, 500}, {0, 0, 0}, 0.4, 160, 120);
    view.distortion = {-0.08, 0.03, 0.001, -0.002, 0.0};
    const Image8 mask = mockup_mask(mesh, view);
    ASSERT_EQ(mask.width, 160);
    ASSERT_EQ(mask.channels, 1);
    int differ = 0, inside = 0;
    for (int y = 0; y < 120; ++y)
        for (int x = 0; x < 160; ++x) {
            const Ray ray = ray_through(view, {x + 0.5, y + 0.5});
            const glm::dvec3 away = ray.origin - glm::dvec3(20, 0, 0);
            const double along = glm::dot(away, ray.direction);
            const bool hits = glm::dot(away, away) - along * along < 40.0 * 40.0;
            inside += hits;
            differ += hits != (mask.at(x, y) != 0);
        }
    EXPECT_GT(inside, 1000);
    // The silhouette of 96 chords lies a fiftieth of a pixel inside the sphere's.
    EXPECT_LE(differ, 4);
}

TEST(MockupMask, LeavesOutWhatIsBehindTheViewOrBesideThePicture) {
    const View view = look_at({0, 0, 500}, {0, 0, 0}, 0.2, 40, 30);
    for (const glm::dvec3 at : {glm::dvec3(0, 0, 900), glm::dvec3(400, 0, 0)}) {
        const Image8 mask = mockup_mask(make_sphere(at, 30.0, 12, "ball"), view);
        for (const auto value : mask.values) EXPECT_EQ(value, 0);
    }
}

TEST(CoverageMask, CountsHalfCoveredPixels) {
    ImageF picture(3, 1, 4);
    picture.at(1, 0, 3) = 0.5f;
    picture.at(2, 0, 3) = 0.49f;
    EXPECT_EQ(coverage_mask(picture).values, (std::vector<std::uint8_t>{0, 255, 0}));
    EXPECT_THROW(coverage_mask(ImageF(3, 1, 3)), std::invalid_argument);
}

}  // namespace
}  // namespace livery
