// The eye's picture of the bench: what the audience sees, wherever the light falls.
#include <cmath>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "twin/small_bench.h"

namespace livery {
namespace {

using testing::filled;
using testing::flat;
using testing::make_rectangle;
using testing::make_wall;
using testing::product_of;
using testing::wall_bench;

float at_place(const ImageF& picture, const View& view, const glm::dvec3& place, int channel) {
    const auto pixel = project(view, place);
    return picture.at(static_cast<int>(pixel->x), static_cast<int>(pixel->y), channel);
}

TEST(EyePicture, IsAsFineAsTheProjectorsAndHoldsTheWholeMockup) {
    const BenchDescription description = wall_bench();
    const Mesh wall = make_wall();
    const View eye = eye_view(description.eye_mm, description.projector.view, wall);
    EXPECT_NEAR(glm::length(centre_in_world(eye) - description.eye_mm), 0.0, 1e-9);
    for (const glm::vec3& corner : wall.positions_mm) {
        const auto pixel = project(eye, corner);
        ASSERT_TRUE(pixel);
        EXPECT_TRUE(pixel->x > 0 && pixel->y > 0 && pixel->x < eye.width && pixel->y < eye.height);
    }
    // The wall's middle is what it is seen at: one pixel's width is the projector's there.
    const double projector_mm = 500.0 / description.projector.view.focal_px.x;
    EXPECT_NEAR(glm::length(description.eye_mm) / eye.focal_px.x, projector_mm, 1e-9);
    EXPECT_THROW(eye_view({0, 0, 50}, description.projector.view, wall), std::invalid_argument);
}

TEST(EyePicture, SeesThePlaceThatAProjectorPixelLights) {
    const BenchDescription description = wall_bench();
    const Bench bench(description, product_of(make_wall()), {}, EyePicture::traced);
    const View& projector = description.projector.view;
    const View& eye = bench.eye().view;

    // White: the same wall is as bright in both, place by place.
    const Image8 white = filled(description, 255, 255, 255);
    const ImageF pixels = bench.observe_xyz(white), seen = bench.observe_from_eye(white);
    for (const glm::dvec3 place : {glm::dvec3(0, 0, 0), {-70, 40, 0}, {80, -50, 0}}) {
        for (int c = 0; c < 3; ++c) {
            const float expected = at_place(pixels, projector, place, c);
            EXPECT_NEAR(at_place(seen, eye, place, c), expected, 0.01 * expected);
        }
    }

    // A block of 9 projector pixels around one place lights that place and no other.
    const glm::dvec3 here(-70, 40, 0), elsewhere(60, 20, 0);
    Image8 spot = filled(description, 0, 0, 0);
    const auto pixel = project(projector, here);
    for (int v = -1; v <= 1; ++v)
        for (int u = -1; u <= 1; ++u)
            for (int c = 0; c < 3; ++c)
                spot.at(static_cast<int>(pixel->x) + u, static_cast<int>(pixel->y) + v, c) = 255;
    const ImageF lit = bench.observe_from_eye(spot);
    EXPECT_NEAR(at_place(lit, eye, here, 1), at_place(seen, eye, here, 1), 1e-4);
    EXPECT_LT(at_place(lit, eye, elsewhere, 1), 1e-4);
}

TEST(EyePicture, KnowsWhatIsUnlitAtAnEdgeAndInReach) {
    // A plate before the wall throws a shadow that the eye, standing aside, sees.
    Mesh mesh = make_wall();
    append(mesh, make_rectangle({-20, -20, 250}, {40, 0, 0}, {0, 40, 0}, "plate"), "");
    BenchDescription description = wall_bench();
    description.projector.white_segment = 0.6;
    const Bench bench(description, product_of(mesh), {}, EyePicture::traced);
    const auto& [view, eye] = bench.eye();
    const auto mask_at = [&v = view](const Image8& mask, const glm::dvec3& place) {
        const auto pixel = project(v, place);
        return mask.at(static_cast<int>(pixel->x), static_cast<int>(pixel->y));
    };
    const glm::dvec3 shadow(25, 0, 0), open(-120, -60, 0), border(-40, 0, 0);
    EXPECT_EQ(mask_at(eye.truth.seen_by_eye, shadow), 255);
    EXPECT_EQ(mask_at(eye.truth.lit, shadow), 0);
    EXPECT_EQ(mask_at(eye.truth.lit, open), 255);
    EXPECT_EQ(mask_at(eye.truth.edge, open), 0);
    EXPECT_EQ(mask_at(eye.truth.edge, border), 255) << "the shadow's border";

    // What a drive shows is in reach; ten times that is not; nothing is in the shadow but black.
    const ImageF shown = bench.observe_from_eye(filled(description, 180, 120, 60));
    ImageF bright = shown;
    for (float& value : bright.values) value *= 10.0f;
    EXPECT_EQ(mask_at(bench.reachable_from_eye(shown), open), 255);
    EXPECT_EQ(mask_at(bench.reachable_from_eye(bright), open), 0);
    EXPECT_EQ(mask_at(bench.reachable_from_eye(bright), shadow), 0);

    // Projector pixels left of the middle light the left of the wall.
    Image8 left(description.projector.view.width, description.projector.view.height, 1);
    for (int y = 0; y < left.height; ++y)
        for (int x = 0; x < left.width / 2; ++x) left.at(x, y) = 255;
    EXPECT_EQ(mask_at(mostly_lit_by(eye, left), {-100, -50, 0}), 255);
    EXPECT_EQ(mask_at(mostly_lit_by(eye, left), {100, -50, 0}), 0);
}

// The photographs, and what is true of the projector's pixels, are not touched by it.
TEST(EyePicture, ChangesNothingElse) {
    Mesh mesh = make_wall();
    append(mesh, make_rectangle({-60, -140, 0}, {0, 280, 0}, {0, 0, 120}, "fin"), "");
    BenchDescription description = wall_bench();
    description.eye_mm = {200, 100, 450};
    description.mockup.interreflection = true;
    description.ambient = 0.01;
    Bench with(description, product_of(mesh), {}, EyePicture::traced);
    Bench without(description, product_of(mesh));
    const Image8 picture = filled(description, 200, 90, 140);
    EXPECT_EQ(with.observe_xyz(picture).values, without.observe_xyz(picture).values);
    const BenchPorts a = with.ports(), b = without.ports();
    a.show(picture);
    b.show(picture);
    EXPECT_EQ(a.photograph(0.0).image.values, b.photograph(0.0).image.values);
    EXPECT_THROW(without.eye(), std::invalid_argument);
    EXPECT_THROW(without.observe_from_eye(picture), std::invalid_argument);

    // Light between the parts is in the eye's picture as well: beside the fin the wall is brighter
    // than without it. The bounce alone is a few percent there.
    BenchDescription direct = description;
    direct.mockup.interreflection = false;
    const Bench plain(direct, product_of(mesh), {}, EyePicture::traced);
    const View& eye = with.eye().view;
    const glm::dvec3 beside(-30, 0, 0);
    const float bounced = at_place(with.observe_from_eye(picture), eye, beside, 1);
    const float alone = at_place(plain.observe_from_eye(picture), eye, beside, 1);
    EXPECT_GT(bounced, 1.01f * alone);
    EXPECT_NEAR(bounced,
                at_place(with.observe_xyz(picture), description.projector.view, beside, 1),
                0.02 * bounced);
}

}  // namespace
}  // namespace livery
