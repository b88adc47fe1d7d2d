#include <array>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "scene/mockup_mask.h"

namespace livery {
namespace {

const WireframeColours kColours{};

bool is(const Image8& picture, int x, int y, const glm::u8vec3& colour) {
    return picture.at(x, y, 0) == colour.x && picture.at(x, y, 1) == colour.y &&
           picture.at(x, y, 2) == colour.z;
}

int count(const Image8& picture, const glm::u8vec3& colour) {
    int found = 0;
    for (int y = 0; y < picture.height; ++y)
        for (int x = 0; x < picture.width; ++x) found += is(picture, x, y, colour);
    return found;
}

/// Rectangles in planes of constant z, one part each, that face +z.
Mesh cards(const std::vector<std::array<double, 5>>& left_right_low_high_z) {
    Mesh mesh;
    for (const auto& [left, right, low, high, z] : left_right_low_high_z) {
        const auto first = static_cast<unsigned>(mesh.positions_mm.size());
        for (const auto& [x, y] : {std::pair{left, low}, {right, low}, {right, high}, {left, high}})
            mesh.positions_mm.emplace_back(x, y, z);
        mesh.triangles.push_back({first, first + 1, first + 2});
        mesh.triangles.push_back({first, first + 2, first + 3});
        const auto part = static_cast<std::uint16_t>(mesh.parts.size());
        mesh.triangle_part.insert(mesh.triangle_part.end(), {part, part});
        mesh.parts.emplace_back().name = "card " + std::to_string(part);
    }
    compute_normals(mesh);
    return mesh;
}

View from_the_front() { return look_at({0, 0, 1000}, {0, 0, 0}, 0.3, 320, 240); }

TEST(Wireframe, ASphereIsItsOutline) {
    const Mesh mesh = make_sphere({0, 0, 0}, 80.0, 96, "ball");
    const View view = from_the_front();
    const Image8 picture = wireframe_picture(mesh, view), mask = mockup_mask(mesh, view);
    EXPECT_EQ(count(picture, kColours.line), 0);
    int outline = 0;
    for (int y = 1; y < picture.height; ++y)
        for (int x = 1; x < picture.width; ++x) {
            const bool border = (mask.at(x, y) != 0) != (mask.at(x - 1, y) != 0) ||
                                (mask.at(x, y) != 0) != (mask.at(x, y - 1) != 0);
            EXPECT_EQ(is(picture, x, y, kColours.outline), border) << x << " " << y;
            outline += border;
        }
    EXPECT_GT(outline, 300);
}

TEST(Wireframe, CreasesAndPartsAreLines) {
    // Two cards edge to edge in one plane: their border is a part's; one ramp behind another part.
    Mesh mesh = cards({{-80, 0, -60, 60, 0}, {0, 80, -60, 60, 0}});
    EXPECT_GT(count(wireframe_picture(mesh, from_the_front()), kColours.line), 70);
    mesh.triangle_part = {0, 0, 0, 0};
    EXPECT_EQ(count(wireframe_picture(mesh, from_the_front()), kColours.line), 0);
    // Folded away by 45 degrees along the border: a crease of one part.
    for (const std::size_t k : {5u, 6u}) mesh.positions_mm[k].z = -80.0f;
    EXPECT_GT(count(wireframe_picture(mesh, from_the_front()), kColours.line), 70);
}

TEST(Wireframe, WhatIsHiddenIsNotDrawn) {
    const Mesh before = cards({{-80, 80, -60, 60, 0}});
    const Mesh hidden = cards({{-80, 80, -60, 60, 0}, {-40, 40, -30, 30, -100}});
    const Mesh seen = cards({{-80, 80, -60, 60, 0}, {-40, 40, -30, 30, 100}});
    const Image8 alone = wireframe_picture(before, from_the_front());
    EXPECT_EQ(alone.values, wireframe_picture(hidden, from_the_front()).values);
    const int more = count(wireframe_picture(seen, from_the_front()), kColours.outline) -
                     count(alone, kColours.outline);
    EXPECT_GT(more, 150);  // Its own border, and no crease.
}

TEST(Wireframe, FollowsTheView) {
    const Mesh mesh = cards({{-80, 80, -60, 60, 0}});
    View view = from_the_front();
    const Image8 before = wireframe_picture(mesh, view);
    view.principal_px += glm::dvec2(3.0, 2.0);
    const Image8 after = wireframe_picture(mesh, view);
    for (int y = 2; y < before.height; ++y)
        for (int x = 3; x < before.width; ++x)
            ASSERT_EQ(is(after, x, y, kColours.outline), is(before, x - 3, y - 2, kColours.outline))
                << x << " " << y;
}

TEST(Wireframe, NothingInSightIsADimPicture) {
    const View away = look_at({0, 0, 1000}, {0, 0, 2000}, 0.3, 64, 48);
    const Image8 picture = wireframe_picture(cards({{-80, 80, -60, 60, 0}}), away);
    EXPECT_EQ(count(picture, kColours.elsewhere), 64 * 48);
    EXPECT_EQ(count(wireframe_picture(Mesh{}, away), kColours.elsewhere), 64 * 48);
}

}  // namespace
}  // namespace livery
