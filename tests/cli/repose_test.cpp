// livery calibrate repose as people call it: calibrated, bumped, found again.
#include <gtest/gtest.h>

#include "core/json.h"
#include "support/run_program.h"
#include "support/small_bench_file.h"
#include "support/temporary_folder.h"

namespace livery {
namespace {

/// The bench's mock-up shifted along x; all else stays. The bench's frame is the mock-up's.
void bump(const std::filesystem::path& bench_file, double shift_mm) {
    Json bench = read_json_file(bench_file);
    const auto shift = [&](Json& point) { point[0] = point[0].get<double>() - shift_mm; };
    for (const char* view : {"projector", "camera"})
        for (const char* point : {"from_mm", "at_mm"}) shift(bench[view][point]);
    for (auto& surface : bench["surroundings"]) shift(surface["corner_mm"]);
    shift(bench["eye_mm"]);
    write_json_file(bench_file, bench);
}

TEST(Repose, NightlyFindsABumpedMockUpAgain) {
    const TemporaryFolder folder;
    const auto bench = testing::small_bench_file(folder.path());
    const std::string camera = "bench:" + bench.string();
    const std::string monday = (folder / "monday").string(),
                      tuesday = (folder / "tuesday").string();
    const auto livery = [](const std::vector<std::string>& arguments) {
        return run_program(LIVERY_PROGRAM, arguments);
    };
    const ProgramRun made = livery({"capture",
                                    "--camera",
                                    camera,
                                    "--no-preflight",
                                    "--out",
                                    (folder / "captures").string(),
                                    "--calibration",
                                    monday});
    ASSERT_EQ(made.exit_code, 0) << made.err;
    bump(bench, 4.0);
    const ProgramRun drift =
        livery({"calibrate", "drift", "--calibration", monday, "--camera", camera});
    EXPECT_EQ(drift.exit_code, 1) << drift.out;

    const ProgramRun found = livery({"calibrate",
                                     "repose",
                                     "--calibration",
                                     monday,
                                     "--camera",
                                     camera,
                                     "--out",
                                     tuesday,
                                     "--json"});
    ASSERT_EQ(found.exit_code, 0) << found.out << found.err;
    const Json figures = Json::parse(found.out);
    EXPECT_NEAR(figures["moved_mm"].get<double>(), 4.0, 0.5);
    EXPECT_TRUE(figures["drift_can_be_told"].get<bool>());
    const ProgramRun settled =
        livery({"calibrate", "drift", "--calibration", tuesday, "--camera", camera});
    EXPECT_EQ(settled.exit_code, 0) << settled.out << settled.err;

    // Another product never stood there.
    const ProgramRun other = livery({"calibrate",
                                     "repose",
                                     "--calibration",
                                     monday,
                                     "--camera",
                                     camera,
                                     "--product",
                                     "sphere",
                                     "--out",
                                     (folder / "other").string(),
                                     "--json"});
    EXPECT_EQ(other.exit_code, 1) << other.out;
    EXPECT_TRUE(Json::parse(other.out).contains("refused")) << other.out;
    EXPECT_FALSE(std::filesystem::exists(folder / "other"));
}

}  // namespace
}  // namespace livery
