// Where everything stands on a bench, from its photographs: nothing of the file's pose is used.
#include <gtest/gtest.h>

#include "core/error.h"
#include "jobs/calibrate/bench_calibration.h"
#include "jobs/comparison.h"
#include "jobs/half_size_bench.h"
#include "scene/library.h"
#include "support/kept_light.h"
#include "support/thorough.h"
#include "twin/bench.h"

namespace livery {
namespace {

ErrorStatistics offset_of(const Bench& bench, const Product& product, const View& found) {
    const ErrorStatistics off = picture_offset(
        bench.description().projector.view, product.mesh, found, product.mesh, bench.truth().lit);
    std::printf("    %s: picture off its place %.3f / %.3f px\n",
                bench.description().name.c_str(),
                off.median,
                off.p95);
    return off;
}

void expect_in_place(const Bench& bench, const Product& product, const RoomPose& room) {
    const ErrorStatistics off = offset_of(bench, product, room.geometry.projector);
    EXPECT_LT(off.median, 0.5);
    EXPECT_LT(off.p95, 1.0);
    EXPECT_GT(off.pixels, 10000u);
}

TEST(RoomPose, NightlyIsFoundOnTheHardBench) {
    const BenchDescription description = half_size("hard");
    const auto product = find_product(description.product.string());
    Bench bench = testing::bench_on_kept_light(description, product);
    expect_in_place(bench, *product, find_room(bench.ports(), settings_of(description, product)));
}

TEST(RoomPose, IsFoundAndLightsTheMockupAloneForTheColours) {
    const BenchDescription description = half_size("default");
    const auto product = find_product(description.product.string());
    Bench bench = testing::bench_on_kept_light(description, product);
    const CalibrationResult found =
        calibrate_through_ports(bench.ports(), settings_of(bench.description(), product));
    ASSERT_TRUE(found.room);
    expect_in_place(bench, *product, *found.room);
    EXPECT_EQ(found.calibration.warnings, std::vector<std::string>());
    // As much is measured as where the pose is told, but for some of the outline (a twentieth of
    // the mock-up at this size), whose code was photographed against a lit table.
    BenchDescription told = description;
    told.data_sheets.reset();
    Bench other = testing::bench_on_kept_light(told, product);
    const CalibrationResult read =
        calibrate_through_ports(other.ports(), settings_of(other.description(), product));
    EXPECT_FALSE(read.room) << "nothing to find it by but the file";
    EXPECT_NEAR(found.calibration.valid_fraction, read.calibration.valid_fraction, 0.02);
    // What stands around is known to the map, and has no correction.
    std::size_t corrected = 0, beside = 0, in_map = 0;
    for (std::size_t i = 0; i < found.calibration.status.values.size(); ++i) {
        const auto status = static_cast<PixelStatus>(found.calibration.status.values[i]);
        corrected += is_valid(status);
        beside += is_valid(status) && !bench.truth().lit.values[i] && !bench.truth().edge.values[i];
        in_map += std::isfinite(found.room->seen.map.camera_px.values[2 * i]);
    }
    EXPECT_GT(in_map, corrected + corrected / 2);
    EXPECT_EQ(beside, 0u);
}

TEST(RoomPose, NightlyOfASphereTakesItsTurnFromTheFile) {
    const BenchDescription description = half_size("sphere");
    const auto product = find_product(description.product.string());
    Bench bench = testing::bench_on_kept_light(description, product);
    const CalibrationResult found =
        calibrate_through_ports(bench.ports(), settings_of(bench.description(), product));
    ASSERT_TRUE(found.room);
    EXPECT_EQ(found.room->geometry.free_turns, 3);
    const ErrorStatistics off = offset_of(bench, *product, found.room->geometry.projector);
    EXPECT_LT(off.median, 0.5);
    EXPECT_LT(off.p95, 1.0);
}

// Somebody measured the wrong thing: a refusal or a pose that is right, never a wrong one.
TEST(RoomPose, NightlyWithWrongDataSheetsIsRefusedOrRight) {
    const BenchDescription description = half_size("default");
    const auto product = find_product(description.product.string());
    Bench bench = testing::bench_on_kept_light(description, product);
    struct Wrong {
        const char* what;
        DataSheets sheets;
    };
    std::vector<Wrong> all;
    const auto add = [&](const char* what, double DataSheets::*field, double factor) {
        all.push_back({what, *description.data_sheets});
        all.back().sheets.*field *= factor;
    };
    add("half the throw ratio", &DataSheets::throw_ratio, 0.5);
    add("a crop sensor's width", &DataSheets::sensor_width_mm, 1.0 / 1.6);
    add("a tape in inches", &DataSheets::lens_distance_mm, 1.0 / 25.4);
    add("the tape to the wall", &DataSheets::lens_distance_mm, 3.0);
    add("no lens shift", &DataSheets::lens_shift, 0.0);
    if (!thorough()) all.resize(1);
    for (const Wrong& wrong : all) {
        SCOPED_TRACE(wrong.what);
        try {
            BenchDescription said = description;
            said.data_sheets = wrong.sheets;
            const RoomPose room = find_room(bench.ports(), settings_of(said, product));
            const ErrorStatistics off = offset_of(bench, *product, room.geometry.projector);
            EXPECT_LT(off.p95, 2.0) << "accepted, and wrong";
        } catch (const Refused& refused) {
            std::printf("    %s: %s\n", wrong.what, refused.what());
            EXPECT_FALSE(refused.fix().empty());
        }
    }
}

}  // namespace
}  // namespace livery
