// The scan against the surface that was there, and as a file that opens as a product.
#include "calibration/scan/scan.h"

#include <cmath>
#include <cstdio>

#include <gtest/gtest.h>

#include "calibration/registration/rotation.h"
#include "calibration/support/traced_sights.h"
#include "core/error.h"
#include "core/paths.h"
#include "core/statistics.h"
#include "mesh/ply_write.h"
#include "scene/product.h"
#include "support/message_of.h"
#include "support/temporary_folder.h"
#include "twin/description.h"

namespace livery {
namespace {

class CarScan : public ::testing::Test {
  protected:
    CarScan()
        : bench_(read_bench_file("default")),
          mesh_(load_product(bench_.product).mesh),
          sight_(testing::traced_sight(
              mesh_, bench_.projector.view, bench_.camera.view, kNoise_px, 5)) {}

    /// Distances of the scan's points from the mesh along the projector's rays.
    std::vector<double> errors_of(const Scan& scan, std::vector<double>* relative = nullptr) const {
        const Tracer tracer(mesh_);
        std::vector<double> errors;
        const glm::dvec3 lamp = centre_in_world(scan.projector);
        for (std::size_t i = 0; i < scan.sigma_mm.values.size(); i += 7) {
            const float* p = &scan.points_mm.values[3 * i];
            if (!std::isfinite(p[0])) continue;
            const glm::dvec3 apart = glm::dvec3(p[0], p[1], p[2]) - lamp;
            const double range = glm::length(apart);
            TraceRay ray;
            ray.origin = glm::vec3(lamp);
            ray.direction = glm::vec3(apart / range);
            const Hit hit = tracer.closest(ray);
            errors.push_back(hit.valid() ? std::abs(range - static_cast<double>(hit.t)) : 100.0);
            if (relative)
                relative->push_back(errors.back() / static_cast<double>(scan.sigma_mm.values[i]));
        }
        return errors;
    }

    static constexpr double kNoise_px = 0.15;
    BenchDescription bench_;
    Mesh mesh_;
    Sight sight_;
};

TEST_F(CarScan, LiesOnTheMeshAsFarAsItSays) {
    const Scan scan = scan_of(bench_.projector.view, std::span(&sight_, 1));
    std::vector<double> relative;
    const std::vector<double> errors = errors_of(scan, &relative);
    std::printf("    %zu points, %.4f mm median, %.4f mm at 95%%, %.2f of sigma, gap %.3f px\n",
                errors.size(),
                median(errors),
                quantile(errors, 0.95),
                median(relative),
                scan.gap_px);
    EXPECT_GT(errors.size(), 20'000u);
    EXPECT_LT(median(errors), 0.2);
    EXPECT_LT(quantile(errors, 0.95), 0.5);
    // Half of a normal distribution lies within 0.67 of its deviation.
    EXPECT_NEAR(median(relative), 0.674, 0.1);
}

TEST_F(CarScan, SaysWhatABumpBeforeItLeaves) {
    EXPECT_TRUE(scan_of(bench_.projector.view, std::span(&sight_, 1)).warnings.empty());
    Sight bumped = sight_;
    for (std::size_t k = 1; k < bumped.map.camera_px.values.size(); k += 2) {
        bumped.map.camera_px.values[k] += 1.5f;
    }
    const Scan scan = scan_of(bench_.projector.view, std::span(&bumped, 1));
    std::printf("    gap %.2f px\n", scan.gap_px);
    ASSERT_EQ(scan.warnings.size(), 1u);
    EXPECT_NE(scan.warnings[0].find("moved since the geometry was calibrated"), std::string::npos);
}

TEST_F(CarScan, FacesOutward) {
    const Scan scan = scan_of(bench_.projector.view, std::span(&sight_, 1));
    const Tracer tracer(mesh_);
    std::vector<double> cosines;
    const glm::dvec3 lamp = centre_in_world(scan.projector);
    for (std::size_t i = 0; i < scan.sigma_mm.values.size(); i += 11) {
        const float *p = &scan.points_mm.values[3 * i], *n = &scan.normals.values[3 * i];
        if (!std::isfinite(n[0])) continue;
        TraceRay ray;
        ray.origin = glm::vec3(lamp);
        ray.direction = glm::normalize(glm::vec3(p[0], p[1], p[2]) - ray.origin);
        const Hit hit = tracer.closest(ray);
        if (!hit.valid()) continue;
        cosines.push_back(static_cast<double>(
            glm::dot(glm::vec3(n[0], n[1], n[2]), surface_point(mesh_, hit).normal)));
    }
    ASSERT_GT(cosines.size(), 10'000u);
    EXPECT_GT(median(cosines), std::cos(0.15));
}

TEST_F(CarScan, IsBetterFromTwoPositionsOfTheCamera) {
    View other = bench_.camera.view;
    other.view_from_world =
        look_at({120, 330, 480}, {0, 25, 0}, 0.4, other.width, other.height).view_from_world;
    const std::vector<Sight> sights{
        sight_, testing::traced_sight(mesh_, bench_.projector.view, other, kNoise_px, 6)};
    const Scan one = scan_of(bench_.projector.view, std::span(&sights[0], 1));
    const Scan both = scan_of(bench_.projector.view, sights);
    EXPECT_GT(both.known_fraction, 1.02 * one.known_fraction);
    EXPECT_LT(median(errors_of(both)), 0.95 * median(errors_of(one)));
}

TEST_F(CarScan, OpensAsAProduct) {
    const Scan scan = scan_of(bench_.projector.view, std::span(&sight_, 1));
    const Mesh surface = mesh_of_scan(scan, 2);
    const TemporaryFolder folder;
    write_text_file(folder / "scan.ply", ply_bytes(surface));
    const Product product = load_product(folder / "scan.ply");
    for (const std::string& note : product.notes) std::printf("    %s\n", note.c_str());
    EXPECT_EQ(product.mesh.triangles.size(), surface.triangles.size());
    const Bounds scanned = bounds_of(product.mesh), car = bounds_of(mesh_);
    for (int c = 0; c < 3; ++c) {
        EXPECT_GT(scanned.low[c], car.low[c] - 1.0);
        EXPECT_LT(scanned.high[c], car.high[c] + 1.0);
    }
    // Counter-clockwise seen from the projector, as it was written.
    const glm::vec3 lamp(centre_in_world(bench_.projector.view));
    std::size_t toward = 0;
    for (const glm::uvec3& triangle : product.mesh.triangles) {
        const glm::vec3 a = product.mesh.positions_mm[triangle.x];
        const glm::vec3 normal = glm::cross(product.mesh.positions_mm[triangle.y] - a,
                                            product.mesh.positions_mm[triangle.z] - a);
        toward += glm::dot(normal, lamp - a) > 0.0f;
    }
    EXPECT_GT(static_cast<double>(toward), 0.999 * static_cast<double>(surface.triangles.size()));
}

TEST_F(CarScan, IsCutWhereTheDepthJumps) {
    // A wall far behind: nothing hangs between it and the car.
    Mesh world = mesh_;
    testing::add_rectangle(world, {-400, -300, -400}, {500, 0, -500}, {0, 900, 0});
    const Sight sight =
        testing::traced_sight(world, bench_.projector.view, bench_.camera.view, kNoise_px, 7);
    const Mesh surface = mesh_of_scan(scan_of(bench_.projector.view, std::span(&sight, 1)));
    float longest = 0.0f;
    for (const glm::uvec3& triangle : surface.triangles)
        longest = std::max(
            longest,
            glm::length(surface.positions_mm[triangle.x] - surface.positions_mm[triangle.y]));
    EXPECT_LT(longest, 4.0f);
    EXPECT_GT(surface.triangles.size(), 100'000u);
}

TEST_F(CarScan, RefusesMovedDevicesAndMirroredPhotographs) {
    Sight moved = sight_;
    moved.camera.view_from_world =
        Rigid3{rotation_of({0.03, 0.0, 0.0}), glm::dvec3(0.0)} * moved.camera.view_from_world;
    EXPECT_NE(message_of([&] {
                  scan_of(bench_.projector.view, std::span(&moved, 1));
              }).find("pass each other"),
              std::string::npos);
    Sight mirrored = sight_;
    for (std::size_t i = 0; i < mirrored.map.camera_px.values.size(); i += 2)
        mirrored.map.camera_px.values[i] =
            static_cast<float>(mirrored.camera.width) - mirrored.map.camera_px.values[i];
    EXPECT_NE(message_of([&] {
                  scan_of(bench_.projector.view, std::span(&mirrored, 1));
              }).find("mirrored"),
              std::string::npos);
}

}  // namespace
}  // namespace livery
