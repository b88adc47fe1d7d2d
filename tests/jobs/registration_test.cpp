// From photographs of the full bench to the scan and the mock-up's pose, as the commands do it; and
// what is said of folders that do not belong together.
#include "jobs/registration.h"

#include <cmath>
#include <cstdio>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "calibration/correspondence/patterns.h"
#include "capture/patterns_folder.h"
#include "core/paths.h"
#include "core/statistics.h"
#include "jobs/file_check.h"
#include "jobs/half_size_bench.h"
#include "jobs/simulated_captures.h"
#include "scene/library.h"
#include "support/message_of.h"
#include "support/reference_data.h"
#include "support/temporary_folder.h"
#include "support/thorough.h"

namespace livery {
namespace {

/// Of the full bench's pixels an axis; all of them at night.
double scale() { return thorough() ? 1.0 : 0.5; }

/// The car on the bench, photographed once; a geometry's calibration with exact lenses and one with
/// focal lengths 1% off, both in the camera's frame.
class BenchRegistration : public ::testing::Test {
  protected:
    static void SetUpTestSuite() {
        shared_ = new TemporaryFolder;
        bench_ =
            new BenchDescription(thorough() ? read_bench_file("default") : half_size("default"));
        const View& projector = bench_->projector.view;
        std::vector<PatternFile> files;
        for (const Pattern& one : geometry_patterns(projector.width, projector.height))
            files.push_back({one.role, one.drive, one.drive_values});
        write_patterns_folder(*shared_ / "patterns", projector.width, projector.height, files);
        photograph_patterns({*bench_, *shared_ / "patterns", *shared_ / "captures"});
        write_calibration_files("exact", 0.0);
        write_calibration_files("off", 0.01);
    }
    static void TearDownTestSuite() {
        delete bench_;
        delete shared_;
    }
    static void write_calibration_files(const char* name, double lens_off) {
        View camera = bench_->camera.view, projector = bench_->projector.view;
        projector.view_from_world = projector.view_from_world * inverse(camera.view_from_world);
        camera.view_from_world = {};
        camera.focal_px *= 1.0 + lens_off;
        projector.focal_px *= 1.0 - lens_off;
        std::filesystem::create_directories(*shared_ / name);
        write_camera_file(*shared_ / name / "camera.json", camera);
        write_camera_file(*shared_ / name / "projector.json", projector);
    }
    static RegistrationRequest request(const char* calibration) {
        RegistrationRequest asked;
        asked.product = find_product("car");
        asked.product_name = "car";
        asked.captures = {*shared_ / "captures"};
        asked.calibrations = {*shared_ / calibration};
        return asked;
    }
    /// How far each lit place of the car is drawn from where it is, projector pixels.
    static std::vector<double> errors_of(const View& projector) {
        const std::shared_ptr<const Product> car = find_product("car");
        const Mesh& mesh = car->mesh;
        const Tracer tracer(mesh);
        const View& truth = bench_->projector.view;
        std::vector<double> errors;
        const int step = static_cast<int>(8 * scale());
        for (int y = 0; y < truth.height; y += step)
            for (int x = 0; x < truth.width; x += step) {
                const Ray ray = ray_through(truth, {x + 0.5, y + 0.5});
                TraceRay trace;
                trace.origin = glm::vec3(ray.origin);
                trace.direction = glm::vec3(ray.direction);
                const Hit hit = tracer.closest(trace);
                if (!hit.valid()) continue;
                const auto drawn = project(projector, surface_point(mesh, hit).position_mm);
                errors.push_back(drawn ? glm::length(*drawn - glm::dvec2(x + 0.5, y + 0.5)) : 1e3);
            }
        return errors;
    }

    static TemporaryFolder* shared_;
    static BenchDescription* bench_;
};
TemporaryFolder* BenchRegistration::shared_ = nullptr;
BenchDescription* BenchRegistration::bench_ = nullptr;

TEST_F(BenchRegistration, ScansTheCar) {
    const ScannedLight light = decode_light({*shared_ / "captures"}, {*shared_ / "exact"});
    const ScanFiles files = scan_product(light, 0.3, 0);
    // What of the scan lies on the car: along the projector's rays that meet it.
    const std::shared_ptr<const Product> car = find_product("car");
    const Mesh& mesh = car->mesh;
    const Tracer tracer(mesh);
    const Rigid3 product_from_camera = inverse(bench_->camera.view.view_from_world);
    const glm::dvec3 lamp = centre_in_world(bench_->projector.view);
    std::vector<double> errors;
    for (std::size_t i = 0; i < files.scan.sigma_mm.values.size(); i += 3) {
        const float* p = &files.scan.points_mm.values[3 * i];
        if (!std::isfinite(p[0])) continue;
        const glm::dvec3 apart = product_from_camera * glm::dvec3(p[0], p[1], p[2]) - lamp;
        const double range = glm::length(apart);
        TraceRay ray;
        ray.origin = glm::vec3(lamp);
        ray.direction = glm::vec3(apart / range);
        const Hit hit = tracer.closest(ray);
        if (hit.valid()) errors.push_back(std::abs(range - static_cast<double>(hit.t)));
    }
    std::printf("    %zu points on the car: %.3f mm median, %.3f mm at 95%%; %zu vertices\n",
                errors.size(),
                median(errors),
                quantile(errors, 0.95),
                files.surface.positions_mm.size());
    // A place that is a share of a pixel off is as much farther off as pixels are larger.
    EXPECT_GT(static_cast<double>(errors.size()), 30'000.0 * scale() * scale());
    EXPECT_LT(median(errors), 0.2 / scale());

    const TemporaryFolder folder;
    write_scan(folder / "scan", files);
    for (const char* name : {"scan.ply", "camera.json", "projector.json"})
        EXPECT_TRUE(check_file(folder / "scan" / name).ok()) << name;
    const Mesh read = load_mesh(folder / "scan" / "scan.ply");
    EXPECT_EQ(read.triangles.size(), files.surface.triangles.size());
    // The projector draws the scan where its light fell.
    const View projector = read_camera_file(folder / "scan" / "projector.json");
    const auto place = project(projector, glm::dvec3(read.positions_mm[1000]));
    ASSERT_TRUE(place);
    EXPECT_NEAR(place->x - std::floor(place->x), 0.5, 0.02);
    EXPECT_NEAR(place->y - std::floor(place->y), 0.5, 0.02);
}

TEST_F(BenchRegistration, LeavesTableWallAndFloorOutAndNothingOfTheCar) {
    const ScannedLight light = decode_light({*shared_ / "captures"}, {*shared_ / "exact"});
    const std::shared_ptr<const Product> car = find_product("car");
    const Tracer tracer(car->mesh);
    const View& projector = bench_->projector.view;
    /// Of the scan's points: those on the car, and all others.
    const auto counts = [&](const Scan& scan) {
        std::pair<std::size_t, std::size_t> points;
        for (int y = 0; y < projector.height; ++y)
            for (int x = 0; x < projector.width; ++x) {
                if (!std::isfinite(scan.sigma_mm.at(x, y))) continue;
                const Ray way = ray_through(projector, {x + 0.5, y + 0.5});
                TraceRay ray;
                ray.origin = glm::vec3(way.origin);
                ray.direction = glm::vec3(way.direction);
                ++(tracer.closest(ray).valid() ? points.first : points.second);
            }
        return points;
    };
    const auto [car_before, around_before] = counts(scan_product(light, 0.3, 0).scan);
    // One more than are needed: the wall goes with the table, which it stands behind.
    const ScanFiles files = scan_product(light, 0.3, 3);
    const auto [car_after, around_after] = counts(files.scan);
    std::printf("    car %zu of %zu, around it %zu of %zu; %zu beside the planes\n",
                car_after,
                car_before,
                around_after,
                around_before,
                files.removed.beside);
    EXPECT_GT(static_cast<double>(car_after), 0.999 * static_cast<double>(car_before));
    EXPECT_LT(static_cast<double>(around_after), 0.003 * static_cast<double>(around_before));
    EXPECT_EQ(files.removed.planes.size(), 2u);
    ASSERT_EQ(files.removed.warnings.size(), 1u);
    EXPECT_NE(files.removed.warnings[0].find("2 of the 3 planes"), std::string::npos);
}

// A board before a wall, photographed by others (docs/third-party.md), with the lenses that
// `livery calibrate geometry` finds in their four folders.
TEST(RealScan, NothingIsLeftOfTheWall) {
    LIVERY_NEEDS_REFERENCE_DATA(data);
    const TemporaryFolder folder;
    folder.write("camera.json", R"({"format_version": 1, "width": 1280, "height": 1024,
        "matrix": [3438.82, 0, 597.29, 0, 3438.26, 526.43, 0, 0, 1],
        "distortion": [-0.24226, -0.16455, -0.001241, -0.00066013, 8.0257],
        "rotation": [1, 0, 0, 0, 1, 0, 0, 0, 1], "translation_mm": [0, 0, 0]})");
    folder.write("projector.json", R"({"format_version": 1, "width": 1024, "height": 768,
        "matrix": [1894.34, 0, 489.64, 0, 1901.02, 849.44, 0, 0, 1],
        "distortion": [-0.11956, 0.49383, 0.008968, -0.0010739, -1.3667],
        "rotation": [0.9981091, 0.0166146, -0.0591790, -0.0168993, 0.9998479, -0.0043146,
                     0.0590983, 0.0053065, 0.9982381],
        "translation_mm": [93.451, -625.580, -233.600]})");
    const ScannedLight light = decode_light({data / "procam" / "capture_1"}, {folder.path()});
    const ScanFiles files = scan_product(light, 0.3, 1);
    ASSERT_EQ(files.removed.planes.size(), 1u);
    const RemovedPlane& wall = files.removed.planes.front();
    // The board leans toward it with one edge.
    std::size_t board = 0, on_wall = 0;
    for (std::size_t i = 0; i < files.scan.sigma_mm.values.size(); ++i) {
        const float* p = &files.scan.points_mm.values[3 * i];
        if (!std::isfinite(p[0])) continue;
        const double before = glm::dot(wall.normal, glm::dvec3(p[0], p[1], p[2])) - wall.offset_mm;
        ++(before > 25.0 ? board : on_wall);
    }
    std::printf("    wall %zu (%.2f mm), behind %zu; left: board %zu, beside the wall %zu (%zu)\n",
                wall.points,
                wall.rms_mm,
                wall.behind,
                board,
                on_wall,
                files.removed.beside);
    EXPECT_GT(board, 100'000u);
    EXPECT_LT(on_wall, wall.points / 1000);
}

TEST_F(BenchRegistration, RegistersTheCarFromPhotographs) {
    for (const char* calibration : chosen<const char*>({"off", "exact"}, 1)) {
        const RegisteredMockup found = register_mockup(request(calibration));
        const std::vector<double> errors = errors_of(found.projector);
        std::printf("    lenses %s: %.3f px median, %.3f px at 95%%; residual %.3f px, %.3f mm\n",
                    calibration,
                    median(errors),
                    quantile(errors, 0.95),
                    found.pose.rms_px,
                    found.pose.rms_mm);
        EXPECT_LT(median(errors), 0.5) << calibration;
        EXPECT_LT(quantile(errors, 0.95), 1.0) << calibration;

        const TemporaryFolder folder;
        write_registration(folder / "out", found);
        for (const char* name : {"pose.json", "camera.json", "projector.json"})
            EXPECT_TRUE(check_file(folder / "out" / name).ok()) << name;
        EXPECT_EQ(check_file(folder / "out" / "pose.json").kind, "pose");
        EXPECT_EQ(check_file(folder / "out").kind, "pose");
        EXPECT_TRUE(check_file(folder / "out").ok());
        std::filesystem::remove(folder / "out" / "camera.json");
        EXPECT_FALSE(check_file(folder / "out").ok());
        const MockupPose read = read_pose_file(folder / "out" / "pose.json");
        EXPECT_EQ(read.inliers, found.pose.inliers);
        EXPECT_EQ(read.covariance, found.pose.covariance);
    }
}

TEST_F(BenchRegistration, TakesPickedPointsInEitherPicture) {
    const std::vector<glm::dvec3> places = {
        {-80, 12, 30}, {75, 15, 32}, {10, 50, 20}, {-20, 52, -18}, {60, 30, -20}, {-70, 28, -25}};
    for (const bool in_camera : {true, false}) {
        const View& view = in_camera ? bench_->camera.view : bench_->projector.view;
        const TemporaryFolder folder;
        std::string text = "x_mm,y_mm,z_mm,u_px,v_px\n";
        for (const glm::dvec3& place : places) {
            const glm::dvec2 pixel = *project(view, place) - 0.5;
            for (const double number : {place.x, place.y, place.z, pixel.x})
                text += std::to_string(number) + ",";
            text += std::to_string(pixel.y) + "\n";
        }
        folder.write("points.csv", text);
        RegistrationRequest asked = request("exact");
        asked.captures.clear();
        asked.points = folder / "points.csv";
        const RegisteredMockup found = register_mockup(asked);
        EXPECT_EQ(found.picked_in, in_camera ? "camera" : "projector");
        EXPECT_LT(quantile(errors_of(found.projector), 0.95), 0.05);
        EXPECT_EQ(check_file(folder / "points.csv").kind, "points");
    }
}

TEST_F(BenchRegistration, SaysWhatDoesNotBelongTogether) {
    RegistrationRequest asked = request("exact");
    View other = bench_->projector.view;
    other.width = 1920;
    std::filesystem::create_directories(*shared_ / "other");
    write_camera_file(*shared_ / "other" / "projector.json", other);
    write_camera_file(*shared_ / "other" / "camera.json", bench_->camera.view);
    asked.calibrations = {*shared_ / "other"};
    EXPECT_NE(
        message_of([&] {
            register_mockup(asked);
        }).find(fmt::format("{}x{}", bench_->projector.view.width, bench_->projector.view.height)),
        std::string::npos);
    asked.calibrations = {*shared_ / "nowhere"};
    EXPECT_NE(message_of([&] { register_mockup(asked); }).find("camera.json"), std::string::npos);
    asked = request("exact");
    asked.calibrations = {*shared_ / "exact", *shared_ / "off"};
    EXPECT_NE(message_of([&] { register_mockup(asked); }).find("one for each"), std::string::npos);
}

}  // namespace
}  // namespace livery
