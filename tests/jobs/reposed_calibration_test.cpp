// Calibrated, bumped, found again with two photographs: what the picture and its colours are off
// by before, after, and calibrated anew.
#include "jobs/calibrate/reposed_calibration.h"

#include <cmath>
#include <cstdio>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <gtest/gtest.h>

#include "calibration/registration/rotation.h"
#include "jobs/calibrate/calibration_folder.h"
#include "jobs/comparison.h"
#include "jobs/half_size_bench.h"
#include "scene/mockup_mask.h"
#include "session/small_session.h"
#include "support/kept_light.h"
#include "support/temporary_folder.h"

namespace livery {
namespace {

using testing::judged;
using testing::Judged;
using testing::refusal_of;

/// The mock-up turned about its foot and shifted; all else stays. The bench's frame is the
/// mock-up's.
BenchDescription bumped(BenchDescription description,
                        const glm::dvec3& axis_angle,
                        const glm::dvec3& shift_mm) {
    const Rigid3 then_from_now{rotation_of(axis_angle), shift_mm};
    const Rigid3 now_from_then = inverse(then_from_now);
    for (View* view : {&description.projector.view, &description.camera.view})
        view->view_from_world = view->view_from_world * then_from_now;
    description.eye_mm = now_from_then * description.eye_mm;
    for (auto& [name, one] : description.surroundings) {
        one.corner_mm = now_from_then * one.corner_mm;
        one.side_a_mm = now_from_then.rotation * one.side_a_mm;
        one.side_b_mm = now_from_then.rotation * one.side_b_mm;
    }
    return description;
}

/// Calibrated as it stood, kept as a folder keeps it.
struct CalibratedBench {
    explicit CalibratedBench(const BenchDescription& description)
        : product(find_product(description.product.string())),
          bench(testing::bench_on_kept_light(description, product)) {
        made = calibrate_through_ports(bench.ports(), settings_of(bench.description(), product));
        origin = origin_of(made, settings_of(description, product));
    }
    std::shared_ptr<const Product> product;
    Bench bench;
    CalibrationResult made;
    CalibrationOrigin origin;
};

struct Worth {
    ErrorStatistics off_px;
    Comparison colours;
};

Worth worth_of(const Bench& bench,
               const Product& product,
               const ColourCalibration& calibration,
               const View& projector,
               const char* name) {
    Worth worth;
    worth.off_px = picture_offset(bench.description().projector.view,
                                  product.mesh,
                                  projector,
                                  product.mesh,
                                  bench.truth().lit);
    CalibrationResult live;
    live.calibration = calibration;
    const Image8 mockup = mockup_mask(product.mesh, projector);
    worth.colours = judged(bench, std::move(live), &mockup).comparison;
    std::printf(
        "    %s: picture off its place %.3f / %.3f px; CIEDE2000 %.3f / %.3f inside, "
        "%.3f / %.3f at edges; valid %.1f%% of the reachable inside, %.1f%% of the lit "
        "without a correction\n",
        name,
        worth.off_px.median,
        worth.off_px.p95,
        worth.colours.interior.median,
        worth.colours.interior.p95,
        worth.colours.edge.median,
        worth.colours.edge.p95,
        100.0 * worth.colours.valid_fraction,
        100.0 * worth.colours.masked_fraction);
    return worth;
}

void expect_found_again(const BenchDescription& description,
                        const glm::dvec3& axis_angle,
                        const glm::dvec3& shift) {
    const char* name = description.name.c_str();
    const CalibratedBench then(description);
    Bench now = testing::bench_on_kept_light(bumped(description, axis_angle, shift), then.product);
    BenchPorts ports = now.ports();
    int photographs = 0;
    const TakePhotograph take = ports.photograph;
    ports.photograph = [&](double asked_s) {
        ++photographs;
        return take(asked_s);
    };
    const ReposedCalibration reposed =
        repose_through_ports(ports, then.made.calibration, then.origin, *then.product);
    std::printf(
        "    %s: moved %.2f mm, %.2f degrees; residual %.3f px, %.1f%% agree; %d "
        "photographs, %.1f s\n",
        name,
        reposed.found.moved_mm,
        reposed.found.turned_rad * 57.29578,
        reposed.found.median_px,
        100.0 * reposed.found.agree_share,
        photographs,
        reposed.origin.solve_seconds);
    for (const std::string& warning : reposed.found.warnings)
        std::printf("        %s\n", warning.c_str());
    EXPECT_EQ(photographs, 4) << "two to find it, and white and black for the next look for drift";
    const CalibratedBench anew(now.description());
    const Worth before =
        worth_of(now, *then.product, then.made.calibration, *then.made.projector, "before");
    const Worth still =
        worth_of(then.bench, *then.product, then.made.calibration, *then.made.projector, "unmoved");
    const Worth after =
        worth_of(now, *then.product, reposed.calibration, reposed.found.projector, "after");
    const Worth again =
        worth_of(now, *then.product, anew.made.calibration, *anew.made.projector, "anew");
    // As good as the calibration was, and a fifth of a pixel for what two photographs add to it.
    EXPECT_GT(before.off_px.median, 2.0);
    EXPECT_LT(after.off_px.median, still.off_px.median + 0.2);
    // As good as anew but for a just visible step: what is carried is interpolated between pixels.
    EXPECT_LT(after.colours.interior.median, again.colours.interior.median + 0.5);
    EXPECT_LT(after.colours.interior.p95, again.colours.interior.p95 + 1.5);
    EXPECT_GT(after.colours.valid_fraction, again.colours.valid_fraction - 0.05);

    // The bump is over for whoever looks for drift.
    const Image8 mockup = mockup_mask(then.product->mesh, reposed.found.projector);
    const Image8 old_mockup = mockup_mask(then.product->mesh, *then.made.projector);
    EXPECT_EQ(grade_figures(look_for_drift(now.ports(), *then.origin.ends, old_mockup))[0].grade,
              Grade::bad);
    for (const GradedFigure& figure :
         grade_figures(look_for_drift(now.ports(), reposed.origin.ends.value(), mockup)))
        EXPECT_EQ(figure.grade, Grade::good) << figure.name << " " << figure.value;
}

TEST(ReposedCalibration, NightlyIsAsGoodAsAnewForTheCar) {
    expect_found_again(half_size("default"), {0.0, 0.05, 0.0}, {6.0, 0.0, -5.0});
}
TEST(ReposedCalibration, NightlyIsAsGoodAsAnewForThePlayer) {
    expect_found_again(half_size("player"), {0.0, -0.04, 0.0}, {-4.0, 0.0, 6.0});
}

TEST(ReposedCalibration, IsKeptAndFoundAgainFromItsFolder) {
    const BenchDescription description = testing::small_bench_description();
    const CalibratedBench then(description);
    Bench now = testing::bench_on_kept_light(
        bumped(description, {0.0, 0.04, 0.0}, {4.0, 0.0, -3.0}), then.product);
    const ReposedCalibration reposed =
        repose_through_ports(now.ports(), then.made.calibration, then.origin, *then.product);
    TemporaryFolder folder;
    write_reposed(folder / "again", reposed);
    EXPECT_EQ(read_calibration(folder / "again").id, reposed.calibration.id);
    EXPECT_NE(reposed.calibration.id, then.made.calibration.id);
    const auto origin = read_origin(folder / "again");
    ASSERT_TRUE(origin && origin->room && origin->ends);
    EXPECT_EQ(origin->reposed_from, then.made.calibration.id);
    EXPECT_EQ(origin->room->projector, *projector_view_of(folder / "again"));
    ASSERT_EQ(origin->around.values.size(), then.origin.around.values.size());
    EXPECT_FALSE(origin->around.empty());

    // And once more, from what was kept.
    Bench later = testing::bench_on_kept_light(
        bumped(now.description(), {0.0, -0.03, 0.0}, {-5.0, 0.0, 2.0}), then.product);
    const ReposedCalibration twice = repose_through_ports(
        later.ports(), read_calibration(folder / "again"), *origin, *then.product);
    const ErrorStatistics off = picture_offset(later.description().projector.view,
                                               then.product->mesh,
                                               twice.found.projector,
                                               then.product->mesh,
                                               later.truth().lit);
    const ErrorStatistics first = picture_offset(description.projector.view,
                                                 then.product->mesh,
                                                 *then.made.projector,
                                                 then.product->mesh,
                                                 then.bench.truth().lit);
    std::printf("    small bench, twice: %.3f px off, %.3f px when it was calibrated\n",
                off.median,
                first.median);
    EXPECT_LT(off.median, first.median + 0.3);

    // What is not known any more is not left from before.
    CalibrationOrigin without = *origin;
    without.around = {};
    write_origin(folder / "again", without);
    EXPECT_TRUE(read_origin(folder / "again")->around.empty());
}

TEST(ReposedCalibration, RefusesWhatItsOriginDoesNotSay) {
    const Product& product = *testing::small_bench_product();
    CalibrationOrigin origin;
    EXPECT_NE(refusal_of([&] { stripes_for(origin, product); }).why.find("camera stands"),
              std::string::npos);
    origin.room.emplace();
    origin.product = product.name;
    origin.shape = "another";
    EXPECT_NE(refusal_of([&] { stripes_for(origin, product); }).why.find("mesh"),
              std::string::npos);
}

}  // namespace
}  // namespace livery
