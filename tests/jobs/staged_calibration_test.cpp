// The stages of a calibration on a small bench: kept, gone on with, done anew alone, checked, and
// looked at again later.
#include "jobs/calibrate/staged_calibration.h"

#include <gtest/gtest.h>

#include "calibration/drift.h"
#include "core/error.h"
#include "core/paths.h"
#include "jobs/calibrate/calibration_check.h"
#include "jobs/calibrate/calibration_folder.h"
#include "jobs/captured_calibration.h"
#include "jobs/file_check.h"
#include "scene/mockup_mask.h"
#include "session/small_session.h"
#include "support/file_error.h"
#include "support/kept_light.h"
#include "support/temporary_folder.h"

namespace livery {
namespace {

using testing::refusal_of;
using testing::small_bench_description;
using testing::small_bench_product;

struct Room {
    explicit Room(BenchDescription description = small_bench_description())
        : bench(testing::bench_on_kept_light(description, small_bench_product())),
          ports(bench.ports()) {
        run.folder = folder / "run";
        run.settings = settings_of(description, small_bench_product());
        const TakePhotograph take = ports.photograph;
        ports.photograph = [this, take](double asked_s) {
            ++photographs;
            return take(asked_s);
        };
    }
    /// As another program that begins in the same folder.
    void forget_memory() {
        run.room.reset();
        run.made.reset();
        run.check.reset();
    }
    void find() {
        photographs = 0;
        find_colours(run, ports, {}, {});
    }

    TemporaryFolder folder;
    Bench bench;
    BenchPorts ports;
    StagedCalibration run;
    int photographs = 0;
};

/// A room in which geometry and colours were found, as that left it; found once for all tests.
struct FoundRoom : Room {
    FoundRoom() : all_photographs(first().photographs) {
        const StagedCalibration& found = first().run;
        std::filesystem::copy(found.folder, run.folder, std::filesystem::copy_options::recursive);
        run.room = found.room;
        run.made = found.made;
    }
    int all_photographs;

  private:
    static const Room& first() {
        static const auto found = [] {
            auto room = std::make_unique<Room>();
            room->find();
            return room;
        }();
        return *found;
    }
};

TEST(StagedCalibration, KeepsEachStageAndDoesOneAnewAlone) {
    FoundRoom room;
    const int all = room.all_photographs;
    EXPECT_TRUE(room.run.made->room);
    EXPECT_LE(all,
              expected_photographs(room.run.settings, CalibrationStage::geometry) +
                  expected_photographs(room.run.settings, CalibrationStage::colour) + 12)
        << "what people are told to expect";
    const RoomGeometry geometry = room.run.room->geometry;

    // After a kill nothing is photographed again, and nothing is found again.
    room.forget_memory();
    room.find();
    EXPECT_EQ(room.photographs, 0);
    EXPECT_EQ(room.run.room->geometry.made_of, geometry.made_of);
    EXPECT_EQ(room.run.room->geometry.inliers, geometry.inliers);
    EXPECT_LT(room.run.room->solve_seconds, 1.0);

    forget(room.run, CalibrationStage::colour);
    EXPECT_TRUE(room.run.room) << "the geometry stays";
    room.find();
    EXPECT_GT(room.photographs, 20);
    EXPECT_LT(room.photographs, all / 2 + 5);

    forget(room.run, CalibrationStage::geometry);
    EXPECT_FALSE(std::filesystem::exists(room.run.folder / "colour"));
    room.find();
    EXPECT_NEAR(room.photographs, all, 6);
}

TEST(StagedCalibration, NightlyGoesOnWhereItWasStopped) {
    FoundRoom room;
    // At the geometry's tenth photograph of all, and at the colours' tenth.
    for (const auto stage : {CalibrationStage::geometry, CalibrationStage::colour}) {
        SCOPED_TRACE(static_cast<int>(stage));
        constexpr int stop_at = 10;
        const int all = stage == CalibrationStage::geometry
                            ? room.all_photographs
                            : expected_photographs(room.run.settings, CalibrationStage::colour);
        forget(room.run, stage);
        room.forget_memory();
        BenchPorts cut = room.ports;
        int taken = 0;
        cut.photograph = [&](double asked_s) {
            if (++taken > stop_at) throw Cancelled();
            return room.ports.photograph(asked_s);
        };
        EXPECT_THROW(find_colours(room.run, cut, {}, {}), Cancelled);
        EXPECT_TRUE(can_go_on(room.run, CalibrationStage::geometry) ||
                    can_go_on(room.run, CalibrationStage::colour));
        room.forget_memory();
        room.find();
        EXPECT_NEAR(room.photographs, all - stop_at, 8);  // what was shown again is awaited
        EXPECT_FALSE(can_go_on(room.run, CalibrationStage::colour));
    }
}

TEST(StagedCalibration, IsCheckedWithColoursThatNothingWasFittedTo) {
    EXPECT_THROW(
        [] {
            Room room;
            check_colours(room.run, room.ports, {});
        }(),
        std::invalid_argument);
    FoundRoom room;
    check_colours(room.run, room.ports, {});
    ASSERT_EQ(room.run.check->colours.size(), 4u);
    // The bench's camera at this size has one pixel or two a projector pixel; .5 and 2 are asked of
    // the demo.
    EXPECT_LT(room.run.check->de00.median, 1.0);
    for (const GradedFigure& figure : grade_figures(*room.run.check))
        EXPECT_NE(figure.grade, Grade::bad) << figure.value;

    // A lamp that lost a fifth of its light since is seen.
    BenchPorts dim = room.ports;
    dim.photograph = [&](double asked_s) {
        Photograph photograph = room.ports.photograph(asked_s);
        for (float& value : photograph.image.values)
            value = static_cast<float>(photograph.black_level) +
                    0.8f * (value - static_cast<float>(photograph.black_level));
        return photograph;
    };
    check_colours(room.run, dim, {});
    EXPECT_EQ(grade_figures(*room.run.check)[0].grade, Grade::bad);
}

TEST(StagedCalibration, TellsALaterDayWhatChanged) {
    FoundRoom room;
    const CalibrationOrigin origin = origin_of(*room.run.made, room.run.settings);
    const auto folder = room.folder / "kept";
    write_setup(folder, room.run.made->calibration, *room.run.made->projector);
    write_origin(folder, origin);
    const auto back = read_origin(folder);
    ASSERT_TRUE(back);
    ASSERT_TRUE(back->ends);
    EXPECT_EQ(back->shape, origin.shape);
    EXPECT_EQ(back->ends->white.values, origin.ends->white.values);
    ASSERT_TRUE(back->room);
    EXPECT_EQ(back->room->inliers, origin.room->inliers);
    EXPECT_FALSE(read_origin(room.folder.path()));
    EXPECT_TRUE(check_file(folder / "origin.json").ok());
    EXPECT_EQ(check_file(folder / "room.json").kind, "room");

    // What a hash tells
    EXPECT_TRUE(what_changed(*back, *small_bench_product(), "").empty());
    Product other = *small_bench_product();
    other.mesh.positions_mm[5].x += 1e-3f;
    ASSERT_EQ(what_changed(*back, other, "").size(), 1u);
    EXPECT_NE(what_changed(*back, other, "")[0].find("mesh"), std::string::npos);
    other.name = "boat";
    EXPECT_NE(what_changed(*back, other, "")[0].find("boat"), std::string::npos);
    CalibrationOrigin on_monitor = *back;
    on_monitor.made_with = "a camera, HDMI-1 at 320x200";
    EXPECT_EQ(what_changed(on_monitor, *small_bench_product(), "HDMI-7 at 1x1").size(), 1u);
    EXPECT_TRUE(what_changed(on_monitor, *small_bench_product(), "HDMI-1 at 320x200").empty());

    // What two photographs tell
    const Image8 mockup = mockup_mask(small_bench_product()->mesh, *room.run.made->projector);
    const Drift still = look_for_drift(room.ports, *back->ends, mockup);
    EXPECT_LT(still.shift_median_px, 0.3) << "what is called good";
    EXPECT_EQ(grade_of(grade_figures(still)).grade, Grade::good);
    BenchDescription bumped = small_bench_description();
    bumped.camera.view.principal_px += glm::dvec2(2.0, 1.0);
    Room after(bumped);
    const Drift moved = look_for_drift(after.ports, *back->ends, mockup);
    EXPECT_NEAR(moved.shift_median_px, std::hypot(2.0, 1.0), 0.3);
    EXPECT_EQ(grade_figures(moved)[0].grade, Grade::bad);
}

// Somebody bumps the tripod between two stages.
TEST(StagedCalibration, RefusesWhatMovedAfterTheGeometry) {
    Room room;
    find_geometry(room.run, room.ports, {}, {});
    BenchDescription bumped = small_bench_description();
    bumped.camera.view.principal_px += glm::dvec2(3.0, -2.0);
    Room after(bumped);
    const auto refused = refusal_of([&] { find_colours(room.run, after.ports, {}, {}); });
    EXPECT_NE(refused.fix.find("photograph the geometry again"), std::string::npos)
        << refused.why << ": " << refused.fix;
    EXPECT_FALSE(room.run.made);
}

TEST(StagedCalibration, IsComparedWithAnother) {
    FoundRoom room;
    const ColourCalibration& one = room.run.made->calibration;
    const View& view = *room.run.made->projector;
    const Mesh& mesh = small_bench_product()->mesh;
    const CalibrationDifference same = compare_calibrations(one, view, one, view, mesh);
    EXPECT_LT(same.de00.median, 0.6) << "the drive's steps";
    EXPECT_EQ(same.moved_px.p95, 0.0);
    EXPECT_EQ(same.brightness, 1.0);

    // A lamp of nine tenths: what the older one drives is darker than wanted.
    ColourCalibration dimmer = one;
    for (float& value : dimmer.span.values) value *= 0.9f;
    for (float& value : dimmer.dark.values) value *= 0.9f;
    const CalibrationDifference dimmed = compare_calibrations(one, view, dimmer, view, mesh);
    EXPECT_NEAR(dimmed.brightness, 0.9, 0.01);
    EXPECT_GT(dimmed.de00.median, 1.5);

    View shifted = view;
    shifted.principal_px.x += 3.0;
    EXPECT_NEAR(compare_calibrations(one, view, one, shifted, mesh).moved_px.median, 3.0, 1e-6);
    ColourCalibration larger = one;
    larger.width += 1;
    EXPECT_THROW(compare_calibrations(one, view, larger, view, mesh), std::invalid_argument);
}

// What the stages leave is a captures folder for `livery calibrate color`.
TEST(StagedCalibration, LeavesFoldersThatAnybodyCanCalibrateFrom) {
    FoundRoom room;
    const auto colours = room.run.folder / "colour";
    const ColourCalibration again = calibrate_from_folder({colours, {}, colours / "map.exr"});
    const auto measured = [](const ColourCalibration& calibration) {
        std::size_t count = 0;
        for (const std::uint8_t status : calibration.status.values)
            count += status == static_cast<std::uint8_t>(PixelStatus::measured);
        return static_cast<double>(count);
    };
    // The same photographs and the same map; at the outline the folder does not know the mask.
    EXPECT_NEAR(measured(again) / measured(room.run.made->calibration), 1.0, 0.05);
}

TEST(StagedCalibration, NamesWhatIsWrongInItsFile) {
    const auto refused = [](const std::string& text, const char* field) {
        EXPECT_TRUE(fails_with([&] { parse_origin(text, "origin.json"); }, {"origin.json", field}));
    };
    refused(R"({"format_version": 2})", "format_version");
    refused(R"({"format_version": 1, "kind": "room"})", "kind");
    refused(R"({"format_version": 1, "kind": "origin", "product": "a", "shape": "b",
                "made_with": "c", "capture_seconds": -1, "solve_seconds": 1})",
            "capture_seconds");
    refused(R"({"format_version": 1, "kind": "origin", "product": "a", "shape": "b",
                "made_with": "c", "capture_seconds": 1, "solve_seconds": 1,
                "ends": {"exposure_s": 0, "late": 0, "light": [1, 1, 1]}})",
            "exposure_s");
}

}  // namespace
}  // namespace livery
