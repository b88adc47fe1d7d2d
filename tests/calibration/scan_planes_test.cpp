// Tables and walls taken out of a scan, and what must stay: a van, whose side is flat and large,
// and a plate on the table.
#include "calibration/scan/scan_planes.h"

#include <array>
#include <cmath>
#include <cstdio>
#include <span>
#include <vector>

#include <gtest/gtest.h>

#include "calibration/support/traced_sights.h"
#include "support/thorough.h"
#include "twin/description.h"

namespace livery {
namespace {

enum Thing : std::size_t { kVan, kPlate, kTable, kWall, kNothing, kThings };

/// Boxes on a table before a wall, as the default bench's projector and camera see them, and which
/// of them each projector pixel lights.
struct Scene {
    Mesh world;
    View projector, camera;

    explicit Scene(double wall_mm, bool table = true, float scale = 1.0f, float plate_mm = 0.0f) {
        const BenchDescription bench = read_bench_file("default");
        projector = resized(bench.projector.view, 640, 400);
        camera = resized(bench.camera.view, 864, 576);
        // A van 180 mm long: cargo, cab and bonnet, 2 mm over the table for its wheels.
        box({-90, 2, -35}, {40, 70, 35});
        box({40, 2, -35}, {65, 60, 35});
        box({65, 2, -35}, {90, 32, 35});
        for (const float x : {-60.0f, 60.0f}) box({x - 12, 0, 30}, {x + 12, 2, 35});
        for (auto& place : world.positions_mm) place *= scale;
        add(kVan);
        if (plate_mm > 0.0f) box({100, 0, -60}, {150, plate_mm, 40});
        add(kPlate);
        if (table) testing::add_rectangle(world, {-200, 0, -130}, {0, 0, 300}, {420, 0, 0});
        add(kTable);
        const auto back = static_cast<float>(-wall_mm);
        testing::add_rectangle(world, {-900, -200, back}, {1200, 0, 0}, {0, 900, 0});
        add(kWall);
        find_lit();
    }
    void add(Thing thing) { of_triangle.resize(world.triangles.size(), thing); }
    void box(glm::vec3 low, glm::vec3 high) {
        const glm::vec3 x(high.x - low.x, 0, 0), y(0, high.y - low.y, 0), z(0, 0, high.z - low.z);
        testing::add_rectangle(world, low, y, x);
        testing::add_rectangle(world, low + z, x, y);
        testing::add_rectangle(world, low, z, y);
        testing::add_rectangle(world, low + x, y, z);
        testing::add_rectangle(world, low + y, z, x);
    }
    Scan scan(double noise_px) const {
        const Sight sight = testing::traced_sight(world, projector, camera, noise_px, 21);
        return scan_of(projector, std::span(&sight, 1));
    }
    std::array<std::size_t, kThings> count(const Scan& scan) const {
        std::array<std::size_t, kThings> counts{};
        for (std::size_t i = 0; i < lit.size(); ++i)
            if (std::isfinite(scan.sigma_mm.values[i])) ++counts[lit[i]];
        return counts;
    }

  private:
    void find_lit() {
        const Tracer tracer(world);
        for (int y = 0; y < projector.height; ++y) {
            for (int x = 0; x < projector.width; ++x) {
                const Ray way = ray_through(projector, {x + 0.5, y + 0.5});
                TraceRay ray;
                ray.origin = glm::vec3(way.origin);
                ray.direction = glm::vec3(way.direction);
                const Hit hit = tracer.closest(ray);
                lit.push_back(hit.valid() ? of_triangle[hit.triangle] : kNothing);
            }
        }
    }
    std::vector<Thing> of_triangle, lit;
};

void print(const char* what, const std::array<std::size_t, kThings>& counts) {
    std::printf("    %s: van %zu, plate %zu, table %zu, wall %zu\n",
                what,
                counts[kVan],
                counts[kPlate],
                counts[kTable],
                counts[kWall]);
}

/// `scan` without planes: nothing is left of table and wall, and nearly all of the van.
RemovedPlanes expect_van_alone(const Scene& scene, const Scan& scan, int planes) {
    Scan rest = scan;
    const RemovedPlanes removed = remove_planes(rest, planes);
    const auto before = scene.count(scan), after = scene.count(rest);
    print("whole", before);
    print("left", after);
    EXPECT_EQ(after[kTable], 0u);
    EXPECT_EQ(after[kWall], 0u);
    EXPECT_GT(static_cast<double>(after[kVan]), 0.995 * static_cast<double>(before[kVan]));
    // Every point that is gone is accounted for.
    std::size_t gone = 0;
    for (const RemovedPlane& plane : removed.planes) gone += plane.points + plane.behind;
    EXPECT_EQ(gone + after[kVan] + after[kPlate],
              before[kVan] + before[kPlate] + before[kTable] + before[kWall]);
    EXPECT_LT(removed.beside, after[kPlate] + before[kVan] / 50);
    return removed;
}

TEST(ScanPlanes, LeaveTheVanWhoseSideIsTheLargest) {
    const Scene scene(80.0);
    for (const double noise_px : chosen<double>({0.5, 0.15}, 1)) {
        const Scan scan = scene.scan(noise_px);
        const RemovedPlanes removed = expect_van_alone(scene, scan, 2);
        EXPECT_TRUE(removed.warnings.empty());
        ASSERT_EQ(removed.planes.size(), 2u);
        EXPECT_GT(removed.planes[0].normal.y, 0.9999);
        EXPECT_NEAR(removed.planes[0].offset_mm, 0.0, 0.01);
        EXPECT_GT(removed.planes[1].normal.z, 0.9999);
        EXPECT_NEAR(removed.planes[1].offset_mm, -80.0, 0.03);
        // There is no third, and that is said: not even the side, which is larger than both.
        const RemovedPlanes more = expect_van_alone(scene, scan, 3);
        ASSERT_EQ(more.warnings.size(), 1u);
        EXPECT_NE(more.warnings[0].find("2 of the 3 planes"), std::string::npos)
            << more.warnings[0];
    }
}

TEST(ScanPlanes, LeaveAPlateOnTheTable) {
    // Eight deviations high: beside the plane, and said to be.
    const Scene scene(80.0, true, 1.0f, 2.0f);
    const Scan scan = scene.scan(0.5);
    const RemovedPlanes removed = expect_van_alone(scene, scan, 2);
    Scan rest = scan;
    remove_planes(rest, 2);
    const std::size_t before = scene.count(scan)[kPlate], after = scene.count(rest)[kPlate];
    EXPECT_GT(static_cast<double>(after), 0.97 * static_cast<double>(before));
    EXPECT_GT(removed.beside, before / 2);
}

TEST(ScanPlanes, LeaveASideThatHasNothingBehindIt) {
    // Nothing but the van and a corner of the wall
    const Scene scene(600.0, false);
    Scan scan = scene.scan(0.15);
    EXPECT_LT(scene.count(scan)[kWall], 500u);
    remove_planes(scan, 2);
    EXPECT_GT(scene.count(scan)[kVan], 140'000u);
}

TEST(ScanPlanes, TakeAllOfAWallWhoseLensesAreOff) {
    // A wall that fills most of the picture; a focal length that is 1% off bends it.
    const Scene scene(80.0, false, 0.4f);
    Sight sight = testing::traced_sight(scene.world, scene.projector, scene.camera, 0.15, 22);
    sight.camera.focal_px *= 1.01;
    const RemovedPlanes removed =
        expect_van_alone(scene, scan_of(scene.projector, std::span(&sight, 1)), 1);
    ASSERT_EQ(removed.planes.size(), 1u);
    std::printf("    %.2f mm rms\n", removed.planes[0].rms_mm);
}

TEST(ScanPlanes, AreNoneOfNothing) {
    const Scene scene(80.0);
    Scan scan = scene.scan(0.15);
    const auto before = scene.count(scan);
    EXPECT_TRUE(remove_planes(scan, 0).planes.empty());
    EXPECT_EQ(scene.count(scan), before);
}

}  // namespace
}  // namespace livery
