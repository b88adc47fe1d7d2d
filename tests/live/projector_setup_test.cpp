#include "live/projector_setup.h"

#include <atomic>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "core/paths.h"
#include "jobs/calibrate/bench_calibration.h"
#include "jobs/calibrate/calibration_folder.h"
#include "jobs/synthetic_calibration.h"
#include "scene/mockup_mask.h"
#include "session/small_session.h"
#include "support/file_error.h"
#include "support/kept_light.h"
#include "support/temporary_folder.h"
#include "twin/bench.h"

namespace livery {
namespace {

/// A user's folder of the test's own.
class ProjectorSetupTest : public ::testing::Test {
  protected:
    ProjectorSetupTest() { ::setenv("LIVERY_HOME", (folder_ / "home").c_str(), 1); }
    ~ProjectorSetupTest() override { ::unsetenv("LIVERY_HOME"); }

    static View projector() { return look_at({0, 0, 500}, {0, 0, 0}, 0.3, 32, 20); }

    std::filesystem::path write_small() {
        ColourCalibration calibration = synthetic_calibration(ImageF(32, 20, 1, 1.0f));
        seal(calibration);
        const auto folder = folder_ / "calibration";
        write_setup(folder, calibration, projector());
        return folder;
    }

    TemporaryFolder folder_;
    /// The left half of what the projector of write_small() lights.
    Mesh mesh_ = left_half();

    static Mesh left_half() {
        Mesh mesh = make_sphere({0, 0, 0}, 1.0, 4, "half");
        mesh.positions_mm = {{-200, -100, 0}, {0, -100, 0}, {0, 100, 0}, {-200, 100, 0}};
        mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
        return mesh;
    }
};

TEST_F(ProjectorSetupTest, IsTheCalibrationBakedForItsDesignWhite) {
    const auto folder = write_small();
    const auto setup = load_setup(folder, 20.0, mesh_);
    const ColourCalibration calibration = read_calibration(folder);
    EXPECT_EQ(
        setup->design_white_y,
        design_white_luminance(
            calibration, 20.0, mockup_mask(mesh_, read_camera_file(folder / "projector.json"))));
    ASSERT_TRUE(setup->table && setup->calibration);
    EXPECT_EQ(setup->table->coefficients, bake(calibration, setup->design_white_y).coefficients);
    EXPECT_EQ(setup->calibration->id, calibration.id);
    EXPECT_TRUE(setup->calibration->unmixing.empty());
    EXPECT_EQ(setup->calibration->status.values, calibration.status.values);
    EXPECT_EQ(setup->view.width, 32);
    EXPECT_EQ(setup->why_uncorrected, "");
    // The synthetic light rises to the right, where there is table: it must not count.
    EXPECT_LT(setup->design_white_y, design_white_luminance(calibration, 20.0, {}));
    EXPECT_LT(load_setup(folder, 5.0, mesh_)->design_white_y, setup->design_white_y);
}

std::vector<std::filesystem::path> kept_setups() {
    std::vector<std::filesystem::path> files;
    std::error_code error;
    for (const auto& entry : std::filesystem::directory_iterator(user_folder() / "cache", error)) {
        files.push_back(entry.path());
    }
    return files;
}

void expect_same(const ProjectorSetup& a, const ProjectorSetup& b) {
    EXPECT_EQ(a.view.focal_px, b.view.focal_px);
    EXPECT_EQ(a.design_white_y, b.design_white_y);
    EXPECT_EQ(a.why_uncorrected, b.why_uncorrected);
    ASSERT_TRUE(a.calibration && b.calibration && a.table && b.table);
    EXPECT_EQ(a.calibration->id, b.calibration->id);
    EXPECT_EQ(a.calibration->warnings, b.calibration->warnings);
    EXPECT_EQ(a.calibration->status.values, b.calibration->status.values);
    EXPECT_EQ(a.calibration->xyz_from_camera, b.calibration->xyz_from_camera);
    EXPECT_EQ(a.calibration->response[2].drive_from_n, b.calibration->response[2].drive_from_n);
    EXPECT_EQ(a.calibration->table.n_from_drive, b.calibration->table.n_from_drive);
    EXPECT_EQ(a.calibration->valid_fraction, b.calibration->valid_fraction);
    EXPECT_EQ(a.table->width, b.table->width);
    EXPECT_EQ(a.table->pixels, b.table->pixels);
    EXPECT_EQ(a.table->light, b.table->light);
    EXPECT_EQ(a.table->coefficients, b.table->coefficients);
    EXPECT_EQ(a.table->drive_from_n, b.table->drive_from_n);
    EXPECT_EQ(a.table->non_additive.start, b.table->non_additive.start);
    EXPECT_EQ(a.table->calibration_id, b.table->calibration_id);
}

TEST_F(ProjectorSetupTest, IsKeptAndTheSameAgain) {
    const auto folder = write_small();
    const auto first = load_setup(folder, 20.0, mesh_);
    ASSERT_EQ(kept_setups().size(), 1u);
    expect_same(*load_setup(folder, 20.0, mesh_), *first);
    EXPECT_EQ(kept_setups().size(), 1u);
    load_setup(folder, 5.0, mesh_);
    EXPECT_EQ(kept_setups().size(), 2u) << "another design white is baked otherwise";
    load_setup(folder, 20.0, make_sphere({0, 0, 0}, 30.0, 8, "ball"));
    EXPECT_EQ(kept_setups().size(), 3u) << "another mock-up has another design white";
    EXPECT_TRUE(first->table->gamut.coefficients.empty());
    const auto preserving = load_setup(folder, 20.0, mesh_, GamutMapping::preserve);
    EXPECT_EQ(kept_setups().size(), 4u) << "a gamut mapping is baked too";
    EXPECT_EQ(preserving->table->gamut.coefficients.size(), 12 * preserving->table->pixels.size());
    const auto again = load_setup(folder, 20.0, mesh_, GamutMapping::preserve);
    EXPECT_EQ(kept_setups().size(), 4u);
    EXPECT_EQ(again->table->gamut.coefficients, preserving->table->gamut.coefficients);
    EXPECT_EQ(again->table->gamut.darkest, preserving->table->gamut.darkest);
    EXPECT_EQ(again->table->gamut.own_brightest, preserving->table->gamut.own_brightest);
    EXPECT_EQ(again->table->gamut.floor_lightness, preserving->table->gamut.floor_lightness);
    expect_same(*again, *preserving);
}

TEST_F(ProjectorSetupTest, WhatIsKeptNeverStandsForAChangedCalibration) {
    const auto folder = write_small();
    load_setup(folder, 20.0, mesh_);
    std::ofstream(folder / "dark.exr") << "damaged";
    EXPECT_TRUE(fails_with([&] { load_setup(folder, 20.0, mesh_); }, {"dark.exr"}));
}

TEST_F(ProjectorSetupTest, DamagedOrUnwritableItIsWorkedOutAgain) {
    const auto folder = write_small();
    const auto first = load_setup(folder, 20.0, mesh_);
    for (const std::uintmax_t size :
         {std::uintmax_t{0}, std::uintmax_t{20}, std::uintmax_t{5000}}) {
        std::filesystem::resize_file(kept_setups().front(), size);
        expect_same(*load_setup(folder, 20.0, mesh_), *first);
    }
    const auto file = kept_setups().front();
    std::fstream stream(file, std::ios::in | std::ios::out | std::ios::binary);
    stream.seekp(3000).put('\x55');
    stream.close();
    expect_same(*load_setup(folder, 20.0, mesh_), *first);
    std::filesystem::remove_all(user_folder());
    std::ofstream(user_folder()) << "a file where the user's folder should be";
    expect_same(*load_setup(folder, 20.0, mesh_), *first);
}

TEST_F(ProjectorSetupTest, RefusesFoldersThatAreNone) {
    EXPECT_TRUE(fails_with([&] { load_setup(folder_ / "missing", 20.0, mesh_); },
                           {"missing", "nothing", "a calibration's folder"}));
    const auto folder = write_small();
    std::filesystem::remove(folder / "projector.json");
    EXPECT_TRUE(
        fails_with([&] { load_setup(folder, 20.0, mesh_); }, {"projector.json", "no such file"}));
    std::ofstream(folder / "projector.json") << "{";
    EXPECT_TRUE(fails_with([&] { load_setup(folder, 20.0, mesh_); }, {"projector.json"}));
    write_camera_file(folder / "projector.json", resized(projector(), 64, 20));
    EXPECT_TRUE(fails_with([&] { load_setup(folder, 20.0, mesh_); },
                           {"projector.json", "64 x 20", "32 x 20, as the calibration"}));
}

TEST_F(ProjectorSetupTest, ACalibrationWithoutItsProjectorTakesACameraFile) {
    const auto folder = write_small();
    const auto with_projector = load_setup(folder, 20.0, mesh_);
    std::filesystem::remove(folder / "projector.json");
    EXPECT_FALSE(projector_view_of(folder));

    const auto camera = folder_ / "camera.json";
    write_camera_file(camera, resized(projector(), 64, 20));
    EXPECT_TRUE(fails_with([&] { add_projector(folder, camera); },
                           {"camera.json", "64 x 20", "32 x 20, as the calibration"}));
    EXPECT_TRUE(fails_with([&] { add_projector(folder, folder_ / "none.json"); }, {"none.json"}));
    EXPECT_FALSE(std::filesystem::exists(folder / "projector.json"));

    write_camera_file(camera, projector());
    add_projector(folder, camera);
    EXPECT_EQ(projector_view_of(folder), projector());
    EXPECT_EQ(load_setup(folder, 20.0, mesh_)->design_white_y, with_projector->design_white_y);
}

TEST_F(ProjectorSetupTest, WithoutCalibrationItIsTheBenchsProjectorAndSaysWhy) {
    const auto setup = uncorrected_setup("default");
    EXPECT_EQ(setup->view.width, read_bench_file("default").projector.view.width);
    EXPECT_FALSE(setup->table);
    EXPECT_NE(setup->why_uncorrected, "");
    EXPECT_TRUE(fails_with([] { uncorrected_setup("nowhere"); }, {"nowhere"}));
}

TEST_F(ProjectorSetupTest, CalibrationsOfTheBenchAreKeptNewestFirst) {
    EXPECT_TRUE(kept_calibrations().empty());
    const auto product = testing::small_bench_product();
    Bench bench = testing::bench_on_kept_light(testing::small_bench_description(), product);
    const auto made = calibrate_on_bench(bench, product, {});
    const auto setup = load_setup(made, 20.0, product->mesh);
    EXPECT_GT(setup->calibration->valid_fraction, 0.9);
    EXPECT_GT(setup->calibration->predicted_fraction, 0.0);
    EXPECT_EQ(setup->view.width, 320);
    EXPECT_EQ(made.parent_path(), user_folder() / "calibrations");
    EXPECT_TRUE(made.filename().string().ends_with(setup->calibration->id.substr(0, 8)));

    const auto older = user_folder() / "calibrations/2020-01-01T00-00-00Z-0123abcd";
    std::filesystem::copy(made, older);
    std::filesystem::create_directories(user_folder() / "calibrations/notes");
    EXPECT_EQ(kept_calibrations(), (std::vector{made, older}));
}

TEST_F(ProjectorSetupTest, AStoppedCalibrationLeavesNothingBehind) {
    const auto product = testing::small_bench_product();
    Bench bench = testing::bench_on_kept_light(testing::small_bench_description(), product);
    std::atomic<bool> stop{false};
    Progress progress;
    progress.stop = &stop;
    progress.report = [&](double fraction, std::string_view) { stop = fraction > 0.5; };
    EXPECT_THROW(calibrate_on_bench(bench, product, progress), Cancelled);
    EXPECT_TRUE(std::filesystem::is_empty(user_folder() / "calibrations"));
}

TEST_F(ProjectorSetupTest, AFolderThatCannotBeMadeIsSaidBeforeTheWork) {
    std::filesystem::create_directories(user_folder());
    std::ofstream(user_folder() / "calibrations") << "a file";
    const auto product = testing::small_bench_product();
    Bench bench = testing::bench_on_kept_light(testing::small_bench_description(), product);
    Progress progress;
    progress.report = [](double, std::string_view) { FAIL() << "work began"; };
    EXPECT_TRUE(fails_with([&] { calibrate_on_bench(bench, product, progress); },
                           {"calibrations", "a folder that can be made"}));
}

}  // namespace
}  // namespace livery
