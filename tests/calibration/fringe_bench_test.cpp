// Gray code alone and with fringes, in the same photographs of the simulated bench, against where
// its rays fall.
#include <cmath>
#include <cstdio>
#include <memory>

#include <gtest/gtest.h>

#include "calibration/correspondence/fringe_decode.h"
#include "calibration/scan/scan.h"
#include "calibration/support/bench_world.h"
#include "scene/library.h"
#include "twin/bench.h"

namespace livery {
namespace {

struct CodeErrors {
    double median_px = 0.0, p95_px = 0.0;
};

CodeErrors quantiles_of(std::vector<double> errors) {
    return {quantile(errors, 0.5), quantile(errors, 0.95)};
}

/// The shipped bench with its noise, lens, flare, defocus and light between parts, at half size.
class FringesOnTheBench : public ::testing::Test {
  protected:
    static void SetUpTestSuite() {
        shared_ = new Shared;
        BenchDescription description = read_bench_file("default");
        for (View* view : {&description.projector.view, &description.camera.view})
            *view = resized(*view, view->width / 2, view->height / 2);
        Bench bench(description, find_product("car"));
        const BenchPorts ports = bench.ports();
        const View projector = description.projector.view;
        for (const std::string& role :
             place_roles(PlaceCode::gray_and_phase, projector.width, projector.height)) {
            const std::size_t number = shared_->photographs.size();
            ports.show(
                place_pattern(PlaceCode::gray_and_phase, projector.width, projector.height, number)
                    .drive);
            shared_->photographs.push_back({role, ports.photograph(0.0)});
        }
        shared_->world = testing::bench_world("default");
        shared_->world.projector = projector;
        shared_->world.camera = description.camera.view;
        shared_->gray = decode_gray_code(shared_->photographs, projector.width, projector.height);
        shared_->fine = refine_by_fringes(
            shared_->photographs, shared_->gray, projector.width, projector.height);
    }
    static void TearDownTestSuite() { delete shared_; }

    struct Shared {
        std::vector<RoledPhotograph> photographs;
        testing::BenchWorld world;
        CameraToProjector gray;
        FineCode fine;
    };
    static inline Shared* shared_ = nullptr;

    /// Of the pixels that are fine in one and decoded in the other, from where their rays fall.
    static CodeErrors code_errors(const CameraToProjector& code) {
        const testing::BenchWorld& world = shared_->world;
        const Tracer tracer(world.all);
        std::vector<double> errors;
        for (int y = 0; y < world.camera.height; y += 3)
            for (int x = 0; x < world.camera.width; x += 3) {
                const float sigma = shared_->fine.places.sigma_px.at(x, y, 0);
                if (!(sigma < kWholePixelError) || !code.decoded.at(x, y)) continue;
                const Ray ray = ray_through(world.camera, {x + 0.5, y + 0.5});
                TraceRay trace;
                trace.origin = glm::vec3(ray.origin);
                trace.direction = glm::vec3(ray.direction);
                const Hit hit = tracer.closest(trace);
                if (!hit.valid()) continue;
                const auto truth =
                    project(world.projector, surface_point(world.all, hit).position_mm);
                if (!truth) continue;
                errors.push_back(glm::length(*truth - glm::dvec2(code.projector_px.at(x, y, 0),
                                                                 code.projector_px.at(x, y, 1))));
            }
        return quantiles_of(std::move(errors));
    }
    static CodeErrors map_errors(const ProjectorToCamera& map, const ProjectorToCamera& truth) {
        std::vector<double> errors;
        for (int y = 0; y < map.edge.height; ++y)
            for (int x = 0; x < map.edge.width; ++x) {
                const double dx = map.camera_px.at(x, y, 0) - truth.camera_px.at(x, y, 0);
                const double dy = map.camera_px.at(x, y, 1) - truth.camera_px.at(x, y, 1);
                if (map.edge.at(x, y) || truth.edge.at(x, y) || !std::isfinite(dx + dy)) continue;
                errors.push_back(std::hypot(dx, dy));
            }
        return quantiles_of(std::move(errors));
    }
};

TEST_F(FringesOnTheBench, PlacesAreManyTimesAsExactAsWholePixels) {
    // A whole pixel is off by .38 px in the median. The bench's projector pixels are sharp squares,
    // of which the camera takes 4 x 4 samples a pixel: that staircase leaves up to an eighth of a
    // pixel an axis, and noise a tenth of that. A lens blurs the stairs away.
    const CodeErrors gray = code_errors(shared_->gray), fine = code_errors(shared_->fine.places);
    const FringeReport& report = shared_->fine.report;
    std::printf(
        "projector px off, median and 95%%: Gray code %.3f %.3f, with fringes %.3f %.3f\n"
        "fine %.3f, contradicted %.4f, global %.4f, reported error %.4f px, power %.2f\n",
        gray.median_px,
        gray.p95_px,
        fine.median_px,
        fine.p95_px,
        report.fine_fraction,
        report.contradicted_fraction,
        report.global_fraction,
        report.median_sigma_px,
        report.response_power);
    EXPECT_LT(fine.median_px, 0.1);
    EXPECT_LT(fine.median_px, 0.3 * gray.median_px);
    EXPECT_GT(report.fine_fraction, 0.9);
}

TEST_F(FringesOnTheBench, TheMapAndTheScanAreMoreExact) {
    const testing::BenchWorld& world = shared_->world;
    const int width = world.projector.width, height = world.projector.height;
    const ProjectorToCamera gray = invert_map(shared_->gray, width, height);
    const ProjectorToCamera fine = invert_map(shared_->fine.places, width, height);
    const Sight truth = testing::traced_sight(world.all, world.projector, world.camera, 0.0, 1);
    const CodeErrors of_gray = map_errors(gray, truth.map), of_fine = map_errors(fine, truth.map);
    std::printf(
        "camera px off, median and 95%%: Gray code %.4f %.4f, with fringes %.4f %.4f "
        "(said: %.4f an axis)\n",
        of_gray.median_px,
        of_gray.p95_px,
        of_fine.median_px,
        of_fine.p95_px,
        fine.sigma_px);
    EXPECT_LT(of_fine.median_px, 0.6 * of_gray.median_px);
    EXPECT_LT(of_fine.p95_px, of_gray.p95_px);
    EXPECT_EQ(gray.sigma_px, kMapError);

    const auto scan_gap = [&](const ProjectorToCamera& map) {
        const Sight sight{world.camera, map};
        return scan_of(world.projector, {&sight, 1}).gap_px;
    };
    const double gap_of_gray = scan_gap(gray), gap_of_fine = scan_gap(fine);
    std::printf("rays pass each other, camera px: Gray code %.4f, with fringes %.4f\n",
                gap_of_gray,
                gap_of_fine);
    EXPECT_LT(gap_of_fine, gap_of_gray);
}

}  // namespace
}  // namespace livery
