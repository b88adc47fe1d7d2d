// The generator: the same bytes every time, and the tools under it.
#include <cmath>
#include <numbers>
#include <set>
#include <string>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "car.h"
#include "core/paths.h"
#include "glb.h"
#include "outline.h"
#include "patterns.h"
#include "sheet.h"
#include "solids.h"

namespace livery::assets {
namespace {

TEST(Generation, NightlyIsDeterministicAndWhatIsShipped) {
    const auto first = glb_bytes("car", make_car());
    EXPECT_TRUE(first == glb_bytes("car", make_car()));
    EXPECT_TRUE(first == read_text_file(shipped_path("assets/car.glb")));
}

TEST(Patterns, RepeatWithoutASeam) {
    // Steps across the border are no larger than within the tile: squared, on average
    for (const Image8& tile : {blossoms(128), weave(128)}) {
        const auto steps = [&](int x) {
            double sum = 0.0;
            for (int y = 0; y < tile.height; ++y) {
                for (int c = 0; c < 3; ++c) {
                    const double d = tile.at(x, y, c) - tile.at((x + 1) % tile.width, y, c);
                    sum += d * d;
                }
            }
            return sum;
        };
        double largest = 0.0;
        for (int x = 0; x + 1 < tile.width; ++x) largest = std::max(largest, steps(x));
        EXPECT_LE(steps(tile.width - 1), largest);
    }
}

TEST(Patterns, OfNormalsAreNormals) {
    const Image8 tile = weave(64);
    for (std::size_t i = 0; i < tile.pixel_count(); ++i) {
        glm::dvec3 normal;
        for (int c = 0; c < 3; ++c) {
            normal[c] = tile.values[3 * i + static_cast<std::size_t>(c)] / 127.5 - 1.0;
        }
        EXPECT_NEAR(glm::length(normal), 1.0, 0.01);
        EXPECT_GT(normal.z, 0.5);
    }
}

TEST(Outline, MeasuresDistanceInsideAndOut) {
    const Outline square({{0, 0}, {10, 0}, {10, 10}, {0, 10}}, 0.5);
    EXPECT_NEAR(square.signed_distance({5, 5}), -5.0, 1e-12);
    EXPECT_NEAR(square.signed_distance({5, 12}), 2.0, 1e-12);
    EXPECT_NEAR(square.signed_distance({5, 1}), -1.0, 1e-12);
    // The corner is rounded: its quadratic curve passes a quarter of the way along both edges' cut.
    EXPECT_NEAR(square.signed_distance({0.0, 0.0}), 0.125 * std::sqrt(2.0), 0.02);
}

Sheet flat_sheet(int n) {
    Sheet sheet;
    for (int y = 0; y <= n; ++y) {
        for (int x = 0; x <= n; ++x) sheet.vertices.push_back({{x, 0, y + 1.0}, {0, 1, 0}, {x, y}});
    }
    const auto at = [&](int x, int y) { return static_cast<std::uint32_t>(y * (n + 1) + x); };
    for (int y = 0; y < n; ++y) {
        for (int x = 0; x < n; ++x) {
            sheet.triangles.push_back({{at(x, y), at(x, y + 1), at(x + 1, y + 1)}, 0, 0});
            sheet.triangles.push_back({{at(x, y), at(x + 1, y + 1), at(x + 1, y)}, 0, 0});
        }
    }
    return sheet;
}

double area_of(const Sheet& sheet, int panel) {
    double area = 0.0;
    for (const auto& t : sheet.triangles) {
        if (t.panel != panel) continue;
        const auto& a = sheet.vertices[t.corners.x].position;
        area += 0.5 * glm::length(glm::cross(sheet.vertices[t.corners.y].position - a,
                                             sheet.vertices[t.corners.z].position - a));
    }
    return area;
}

TEST(Cut, FollowsTheCurveAndKeepsTheArea) {
    auto sheet = flat_sheet(20);
    const double radius = 6.3;
    const auto from_centre = [](const LimitVertex& v) {
        return std::hypot(v.position.x - 10.2, v.position.z - 11.1);
    };
    cut(
        sheet,
        [&](const LimitVertex& v) { return from_centre(v) - radius; },
        [](const SheetTriangle&) { return true; },
        [](int) { return 1; });
    // A polygon in a circle with edges about 1 loses r * (edge^2 / 12 r^2) of its area, some 0.5%.
    EXPECT_NEAR(area_of(sheet, 1), std::numbers::pi * radius * radius, 0.01 * 124.7);
    EXPECT_NEAR(area_of(sheet, 0) + area_of(sheet, 1), 400.0, 1e-9);
    for (const auto& t : sheet.triangles) {
        for (int k = 0; k < 3; ++k) {
            const double r = from_centre(sheet.vertices[t.corners[k]]);
            if (t.panel == 1) {
                EXPECT_LT(r, radius + 0.1);
            } else {
                EXPECT_GT(r, radius - 0.1);
            }
        }
    }
}

TEST(Cut, LeavesNoSlivers) {
    // Curves at every offset against the grid.
    for (int step = 0; step < 40; ++step) {
        auto sheet = flat_sheet(6);
        const double offset = 2.0 + step * 0.05;
        cut(
            sheet,
            [&](const LimitVertex& v) { return v.position.x - offset; },
            [](const SheetTriangle&) { return true; },
            [](int) { return 1; });
        for (const auto& t : sheet.triangles) {
            const auto& a = sheet.vertices[t.corners.x].position;
            EXPECT_GT(glm::length(glm::cross(sheet.vertices[t.corners.y].position - a,
                                             sheet.vertices[t.corners.z].position - a)),
                      0.04)
                << "offset " << offset;
        }
        EXPECT_NEAR(area_of(sheet, 0) + area_of(sheet, 1), 36.0, 1e-9);
    }
}

TEST(Panels, StandApartByTheirGap) {
    auto sheet = flat_sheet(8);
    cut(
        sheet,
        [](const LimitVertex& v) { return v.position.x - 4.3; },
        [](const SheetTriangle&) { return true; },
        [](int) { return 1; });
    std::vector<PartMesh> parts(3);
    const std::vector<PanelStyle> styles{{0, 0.0, 0.2, 0.5}, {1, 0.0, 0.2, 0.5}};
    const auto chart = [](const LimitVertex& v, int) { return v.parameters; };
    build_panels(sheet, styles, chart, 2, parts);
    double left = -1e9, right = 1e9;
    for (const auto& p : parts[1].positions_mm) left = std::max(left, p.x);
    for (const auto& p : parts[0].positions_mm) right = std::min(right, p.x);
    EXPECT_NEAR(right - left, 0.2, 1e-9);
    // The joint's bottom lies below both panels.
    ASSERT_FALSE(parts[2].positions_mm.empty());
    for (const auto& p : parts[2].positions_mm) EXPECT_LT(p.y, -0.5);
}

TEST(Solids, RevolvedRingHasItsVolume) {
    // Pappus: a section of 1 x 2 at mean radius 3 sweeps 2 pi 3 2; the polygon of n sides has
    // sin(2 pi / n) / (2 pi / n) of it.
    const int n = 64;
    const auto ring = revolve({{2.5, -1}, {3.5, -1}, {3.5, 1}, {2.5, 1}}, true, n);
    double volume = 0.0;
    for (const auto& t : ring.triangles) {
        volume += glm::dot(ring.positions_mm[t.x],
                           glm::cross(ring.positions_mm[t.y], ring.positions_mm[t.z])) /
                  6.0;
    }
    const double step = 2.0 * std::numbers::pi / n;
    EXPECT_NEAR(volume, 12.0 * std::numbers::pi * std::sin(step) / step, 1e-9);
}

}  // namespace
}  // namespace livery::assets
