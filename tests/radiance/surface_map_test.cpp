#include "radiance/surface_map.h"

#include <chrono>
#include <cmath>
#include <cstdio>
#include <numbers>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/worst_error.h"
#include "radiance/ray_grid.h"

namespace livery {
namespace {

View front_view(int width, int height, double distance_mm, double fov_rad) {
    return look_at({0, 0, distance_mm}, {0, 0, 0}, fov_rad, width, height);
}

SurfaceMap map_of(const Mesh& mesh, const View& view, int samples = 16) {
    return build_surface_map(mesh, Tracer(mesh), view, samples);
}

/// A square of side 2 half_mm facing +z at height z, one part.
Mesh plate(double half_mm, double z_mm, const std::string& name, double centre_x_mm = 0.0) {
    Mesh mesh;
    const auto h = static_cast<float>(half_mm);
    const auto x = static_cast<float>(centre_x_mm);
    const auto z = static_cast<float>(z_mm);
    mesh.positions_mm = {{x - h, -h, z}, {x + h, -h, z}, {x + h, h, z}, {x - h, h, z}};
    mesh.normals.assign(4, {0, 0, 1});
    mesh.tangents.assign(4, {1, 0, 0, 1});
    mesh.uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    mesh.triangle_part = {0, 0};
    mesh.parts = {Part{name, "", glm::dvec3(0.5)}};
    return mesh;
}

TEST(SurfaceMap, SphereCoversItsExactOutline) {
    const double radius = 40.0, distance = 400.0;
    const Mesh mesh = make_sphere({0, 0, 0}, radius, 200, "ball");
    const View view = front_view(160, 120, distance, 0.25);
    const SurfaceMap map = map_of(mesh, view);
    double area = 0.0;
    for (const float c : map.coverage.values) area += c;
    // The outline of a centred sphere is a circle of radius f r / sqrt(d^2 - r^2). 16 samples a
    // pixel on about 500 edge pixels, each with an error of a few percent: .05% of the area.
    const double outline_px =
        view.focal_px.x * radius / std::sqrt(distance * distance - radius * radius);
    EXPECT_NEAR(area / (std::numbers::pi * outline_px * outline_px), 1.0, 1e-3);
}

TEST(SurfaceMap, FragmentsLieOnTheSphereWithItsNormalsAndTheirSpread) {
    const double radius = 40.0, distance = 400.0;
    const Mesh mesh = make_sphere({0, 0, 0}, radius, 300, "ball");
    const View view = front_view(96, 96, distance, 0.25);
    const SurfaceMap map = map_of(mesh, view);
    ASSERT_GT(map.fragments.size(), 1000u);
    const double footprint_mm = (distance - radius) / view.focal_px.x;
    int interior = 0;
    for (const Fragment& f : map.fragments) {
        const glm::dvec3 position(f.position_mm);
        const glm::dvec3 outward = glm::normalize(position);
        EXPECT_NEAR(glm::length(glm::dvec3(f.normal)), 1.0, 1e-5);
        EXPECT_NEAR(glm::dot(f.tangent, glm::vec4(f.normal, 0.0f)), 0.0, 1e-4);
        if (f.coverage < 1.0f || outward.z < 0.8) continue;
        ++interior;
        // A mean over a curved pixel sinks by about footprint^2 / (8 r); the mesh by far less.
        EXPECT_NEAR(glm::length(position), radius, 0.01 * footprint_mm + 0.01);
        EXPECT_LT(glm::length(glm::cross(outward, glm::dvec3(f.normal))), 3e-3);
        // Mean squared slope of a square footprint s on a sphere, foreshortened in one direction:
        // (s/r)^2 (1 + 1/c^2) / 12, less 1/256 for 16 levels; 3% for the change of c over a pixel.
        const glm::dvec3 to_view = glm::normalize(glm::dvec3(0, 0, distance) - position);
        const double c = glm::dot(outward, to_view);
        const double s =
            glm::distance(glm::dvec3(0, 0, distance), position) / view.focal_px.x / radius;
        const double expected = s * s * (1.0 + 1.0 / (c * c)) / 12.0 * (1.0 - 1.0 / 256.0);
        EXPECT_NEAR(f.normal_variance / expected, 1.0, 0.03);
    }
    EXPECT_GT(interior, 500);
}

TEST(SurfaceMap, OrderIsByPartThenPixelAndOffsetsAgree) {
    Mesh mesh = make_sphere({-20, 0, 0}, 15.0, 40, "left");
    append(mesh, make_sphere({20, 0, 0}, 15.0, 40, "right"), "");
    append(mesh, make_sphere({0, 0, -900}, 1.0, 4, "hidden far"), "");
    mesh.parts.push_back(Part{"nothing", "", glm::dvec3(0.5)});
    const SurfaceMap map = map_of(mesh, front_view(64, 48, 300.0, 0.3));
    ASSERT_EQ(map.part_begin.size(), 5u);
    EXPECT_EQ(map.part_begin.front(), 0u);
    EXPECT_EQ(map.part_begin.back(), map.fragments.size());
    EXPECT_EQ(map.part_begin[3], map.part_begin[4]) << "an empty part has an empty range";
    for (std::size_t p = 0; p + 1 < map.part_begin.size(); ++p) {
        for (std::uint32_t i = map.part_begin[p]; i < map.part_begin[p + 1]; ++i) {
            EXPECT_EQ(map.fragments[i].part, p);
            if (i > map.part_begin[p]) {
                EXPECT_LE(map.fragments[i - 1].pixel, map.fragments[i].pixel);
            }
        }
    }
    std::size_t covered = 0;
    for (const float c : map.coverage.values) covered += c > 0.0f ? 1u : 0u;
    EXPECT_EQ(covered, map.covered_pixels);
}

TEST(SurfaceMap, DepthBreakSplitsAPixelIntoTwoFragments) {
    // One part, two plates 50 mm apart in depth, the nearer one ends in the middle of the picture.
    Mesh mesh = plate(40.0, 0.0, "plate");
    const Mesh near = plate(40.0, 50.0, "plate", -40.0);
    append(mesh, near, "");
    mesh.parts.resize(1);
    for (auto& part : mesh.triangle_part) part = 0;
    View view = front_view(21, 21, 500.0, 0.1);
    const SurfaceMap map = map_of(mesh, view);
    const auto middle = static_cast<std::uint32_t>(10 * 21 + 10);
    std::vector<const Fragment*> found;
    for (const Fragment& f : map.fragments) {
        if (f.pixel == middle) found.push_back(&f);
    }
    ASSERT_EQ(found.size(), 2u);
    EXPECT_NEAR(found[0]->coverage, 0.5, 1e-6);
    EXPECT_NEAR(found[1]->coverage, 0.5, 1e-6);
    EXPECT_NEAR(std::abs(found[0]->position_mm.z - found[1]->position_mm.z), 50.0, 1e-3);
}

TEST(SurfaceMap, RidgeSplitsHoweverGentle) {
    // A roof seen from the front: its two slopes meet in the middle column.
    const auto roof = [](float rise) {
        Mesh mesh;
        const float w = 40.0f;
        mesh.positions_mm = {{0, -w, 0},
                             {0, w, 0},
                             {-w, -w, -rise * w},
                             {-w, w, -rise * w},
                             {0, -w, 0},
                             {0, w, 0},
                             {w, -w, -rise * w},
                             {w, w, -rise * w}};
        mesh.triangles = {{2, 0, 1}, {2, 1, 3}, {4, 6, 7}, {4, 7, 5}};
        mesh.triangle_part.assign(4, 0);
        mesh.uvs.assign(8, glm::vec2(0.0f));
        mesh.parts = {Part{"roof", "", glm::dvec3(0.5)}};
        compute_normals(mesh);
        compute_tangents(mesh);
        return mesh;
    };
    const View view = front_view(21, 21, 500.0, 0.1);
    const auto fragments_in_middle = [&](float rise) {
        std::vector<Fragment> found;
        for (const Fragment& f : map_of(roof(rise), view).fragments) {
            if (f.pixel == 10 * 21 + 10) found.push_back(f);
        }
        return found;
    };
    // Rise 0.3 is 33 degrees from side to side, 0.06 is 7.
    for (const float rise : {1.5f, 0.3f, 0.06f}) {
        const auto sides = fragments_in_middle(rise);
        ASSERT_EQ(sides.size(), 2u) << "rise " << rise;
        for (const Fragment& f : sides) {
            EXPECT_LT(f.normal_variance, 1e-6);
            EXPECT_NEAR(f.coverage, 0.5f, 1e-6);
            EXPECT_NEAR(std::abs(f.normal.x / f.normal.z), rise, 1e-3);
        }
    }
    EXPECT_EQ(fragments_in_middle(0.02f).size(), 1u) << "no highlight tells these sides apart";
}

TEST(SurfaceMap, RoundBendStaysOneFragmentAndALongOneIsParted) {
    // A ball of 16 pixels, 7 degrees across each: as much along as across where it is seen
    // straight on. Toward its edge it is a bend along one direction, and a disc of slopes as wide
    // across as along would mirror what no normal there does.
    const Mesh ball = make_sphere({0, 0, 0}, 20.0, 128, "ball");
    for (const int samples : {4, 16}) {
        const SurfaceMap map = map_of(ball, front_view(21, 21, 500.0, 0.1), samples);
        int whole = 0, parted = 0;
        for (const Fragment& f : map.fragments) {
            if (map.coverage.values[f.pixel] < 1.0f) continue;
            if (f.normal.z > 0.9f) {
                EXPECT_FLOAT_EQ(f.coverage, 1.0f) << samples << " samples";
                ++whole;
            }
            if (f.normal.z < 0.45f) {
                EXPECT_LT(f.coverage, 1.0f) << samples << " samples";
                ++parted;
            }
        }
        EXPECT_GE(whole, 25);
        EXPECT_GE(parted, 8);
    }
}

TEST(SurfaceMap, InsideOfAnOpenSurfaceFacesTheView) {
    Mesh mesh = plate(40.0, 0.0, "plate");
    for (auto& t : mesh.triangles) std::swap(t.y, t.z);
    for (auto& n : mesh.normals) n = -n;
    const SurfaceMap map = map_of(mesh, front_view(9, 9, 500.0, 0.1));
    ASSERT_FALSE(map.fragments.empty());
    for (const Fragment& f : map.fragments) EXPECT_NEAR(f.normal.z, 1.0, 1e-6);
}

TEST(SurfaceMap, EmptySpaceCostsNothing) {
    const View view = front_view(320, 320, 500.0, 0.5);
    EXPECT_EQ(tiles_that_see(plate(10.0, 0.0, "small"), view).size(), 4u);
    EXPECT_TRUE(tiles_that_see(plate(10.0, 0.0, "aside", 1000.0), view).empty());
    EXPECT_TRUE(tiles_that_see(plate(10.0, 600.0, "behind"), view).empty());
    EXPECT_EQ(tiles_that_see(plate(1000.0, 0.0, "wall"), view).size(), 400u);
    const SurfaceMap map = map_of(plate(10.0, 0.0, "aside", 1000.0), view);
    EXPECT_TRUE(map.fragments.empty());
    EXPECT_EQ(map.covered_pixels, 0u);
}

TEST(SurfaceMap, PartOfAWallBehindTheViewIsNotLost) {
    // A floor that passes under the view: two triangles with corners behind it.
    Mesh floor = plate(2000.0, 0.0, "floor");
    for (auto& p : floor.positions_mm) p = {p.x, -100.0f, -p.y};
    floor.normals.assign(4, {0, 1, 0});
    const View view = look_at({0, 0, 0}, {0, -200, -300}, 0.6, 128, 96);
    const SurfaceMap map = map_of(floor, view);
    EXPECT_EQ(map.covered_pixels, 128u * 96u);
}

TEST(SurfaceMap, InterpolatedRaysFollowTheLens) {
    // Barrel and pincushion stronger than projectors have, and a lens shift off the picture.
    for (const double k1 : {-0.25, -0.05, 0.05, 0.3}) {
        View view = front_view(1280, 800, 1000.0, 0.5);
        view.distortion = {k1, 0.04, 1e-3, -2e-3, 0.01};
        view.principal_px.y += 600.0;
        double worst_px = 0.0;
        for (const glm::ivec2 tile : {glm::ivec2(0, 0), glm::ivec2(40, 25), glm::ivec2(79, 49)}) {
            const TileRays rays(view, tile);
            for (int k = 0; k < 100; ++k) {
                const glm::dvec2 pixel =
                    glm::dvec2(tile * kTile_px) + glm::dvec2((k % 10) + 0.5, (k / 10) + 0.5) * 1.6;
                const auto direction = rays.direction(pixel);
                ASSERT_TRUE(direction);
                const auto back =
                    project(view, centre_in_world(view) + 1000.0 * glm::dvec3(*direction));
                ASSERT_TRUE(back);
                worst_px = worse_of(worst_px, glm::distance(*back, pixel));
            }
        }
        EXPECT_LT(worst_px, 1e-3) << "k1 = " << k1;
    }
}

TEST(SurfaceMap, RefusesASampleCountThatIsNoSquare) {
    const Mesh mesh = plate(10.0, 0.0, "plate");
    const Tracer tracer(mesh);
    try {
        build_surface_map(mesh, tracer, front_view(8, 8, 100, 0.1), 15);
        FAIL() << "accepted";
    } catch (const std::invalid_argument& error) {
        EXPECT_STREQ(error.what(), "samples_per_pixel is 15, not a square number");
    }
}

TEST(SurfaceMap, StopsWhenAsked) {
    const Mesh mesh = plate(10.0, 0.0, "plate");
    const Tracer tracer(mesh);
    std::atomic<bool> stop = true;
    Progress progress;
    progress.stop = &stop;
    EXPECT_THROW(build_surface_map(mesh, tracer, front_view(8, 8, 100, 0.1), 16, progress),
                 Cancelled);
}

}  // namespace
}  // namespace livery
