// livery capture as people call it.
#include <gtest/gtest.h>

#include "cli/livery_run.h"
#include "core/json.h"
#include "support/small_bench_file.h"
#include "support/temporary_folder.h"

namespace livery {
namespace {

std::string small_bench_camera(const TemporaryFolder& folder) {
    return "bench:" + testing::small_bench_file(folder.path()).string();
}

TEST(Capture, OnTheSimulatedBench) {
    const TemporaryFolder folder;
    const std::string camera = small_bench_camera(folder), out = (folder / "captures").string();
    const std::string calibration = (folder / "calibration").string();
    const ProgramRun first = livery_run(
        {"capture", "--camera", camera, "--out", out, "--calibration", calibration, "--json"});
    ASSERT_EQ(first.exit_code, 0) << first.err;
    const Json made = Json::parse(first.out);
    EXPECT_EQ(made["preflight"].size(), 12u);
    EXPECT_TRUE(made["simulated"].get<bool>());
    EXPECT_GT(made["valid_fraction"].get<double>(), 0.9);
    EXPECT_EQ(made["photographs_kept_from_before"], 0);
    EXPECT_TRUE(std::filesystem::exists(calibration + "/projector.json"));

    // The same again needs no photograph, and one again those of one picture.
    const ProgramRun second = livery_run({"capture", "--camera", camera, "--out", out, "--json"});
    ASSERT_EQ(second.exit_code, 0) << second.err;
    EXPECT_EQ(Json::parse(second.out)["photographs_taken"], 0);
    const ProgramRun again = livery_run(
        {"capture", "--camera", camera, "--out", out, "--again", "gray-row-2", "--json"});
    ASSERT_EQ(again.exit_code, 0) << again.err;
    EXPECT_EQ(Json::parse(again.out)["photographs_taken"], 1);

    // What it leaves is a captures folder.
    const ProgramRun read = livery_run(
        {"calibrate", "color", "--captures", out, "--out", (folder / "read").string(), "--json"});
    EXPECT_EQ(read.exit_code, 0) << read.err;

    const ProgramRun other =
        livery_run({"capture", "--camera", "bench:default", "--no-preflight", "--out", out});
    EXPECT_EQ(other.exit_code, 1);
    EXPECT_NE((other.out + other.err).find("were taken with"), std::string::npos) << other.err;
}

TEST(Capture, LooksOnly) {
    const TemporaryFolder folder;
    const ProgramRun run =
        livery_run({"capture", "--camera", small_bench_camera(folder), "--preflight", "--json"});
    // A quarter of the pixels: the finest stripes are blurred, and that is said.
    const Json figures = Json::parse(run.out)["preflight"];
    ASSERT_EQ(figures.size(), 12u);
    EXPECT_EQ(figures[0]["name"], "Size in the camera");
    for (const Json& figure : figures)
        for (const char* field : {"name", "value", "grade", "meaning", "fix"})
            EXPECT_FALSE(figure[field].get<std::string>().empty()) << figure;
}

TEST(Capture, ListsWhatThereIs) {
    const ProgramRun run = livery_run({"capture", "--list", "--json"});
    EXPECT_EQ(run.exit_code, 0) << run.err;
    const std::string text = run.out;
    EXPECT_NE(text.find("\"bench:default\""), std::string::npos) << text;
}

TEST(Capture, SaysWhatItNeeds) {
    const TemporaryFolder folder;
    const std::string out = (folder / "out").string();
    const std::vector<std::pair<std::vector<std::string>, const char*>> cases{
        {{}, "--camera"},
        {{"--camera", "teapot"}, "bench[:NAME|FILE]"},
        {{"--camera", "bench"}, "--out"},
        {{"--camera", "bench:no such bench", "--out", out}, "no such bench"},
        {{"--camera", "bench", "--monitor", "2", "--out", out}, "projector of its own"},
        {{"--camera", "video:" + out + "/none.avi", "--out", out}, "does not open"},
        {{"--camera", "folder:" + out}, "--monitor"},
        {{"--camera", "video:0", "--pose", "a.json", "--out", out}, "--product"},
    };
    for (const auto& [arguments, said] : cases) {
        std::vector<std::string> all{"capture"};
        all.insert(all.end(), arguments.begin(), arguments.end());
        const ProgramRun run = livery_run(all);
        EXPECT_NE(run.exit_code, 0) << said;
        EXPECT_NE(run.err.find(said), std::string::npos) << said << ": " << run.err;
    }
}

}  // namespace
}  // namespace livery
