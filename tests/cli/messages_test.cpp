// What the program says, and how it ends, when it is used in a way that nobody planned.

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sys/types.h>
#include <unistd.h>

#include "cli/livery_run.h"
#include "scene/view.h"

namespace livery {
namespace {

using Json = nlohmann::ordered_json;

/// Exit status 2, and one line on stderr with every one of these texts in it.
void expect_refusal(const std::vector<std::string>& arguments,
                    const std::vector<std::string>& parts) {
    const ProgramRun run = livery_run(arguments);
    EXPECT_EQ(run.exit_code, 2) << arguments[0] << ": " << run.err;
    EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
    EXPECT_TRUE(run.out.empty()) << run.out;
    for (const auto& part : parts) EXPECT_NE(run.err.find(part), std::string::npos) << run.err;
}

TEST(Messages, NameTheOptionWhatWasFoundAndWhatWasExpected) {
    expect_refusal({"polish"}, {"\"polish\"", "livery help"});
    expect_refusal({"calibrate"}, {"\"calibrate\"", "livery help"});
    expect_refusal({"calibrate", "weather"}, {"\"calibrate weather\"", "livery help"});
    const auto geometry = [](std::vector<std::string> more) {
        std::vector<std::string> all = {
            "calibrate", "geometry", "--captures", "x", "--projector", "1024x768", "--out", "y"};
        all.insert(all.end(), more.begin(), more.end());
        return all;
    };
    expect_refusal(geometry({"--board", "9by7"}), {"--board", "9by7", "COLUMNSxROWS"});
    expect_refusal(geometry({"--board", "9x7"}), {"--square-mm", "found 0", "more than 0"});
    expect_refusal(geometry({"--board", "charuco:9x7", "--square-mm", "20", "--marker-mm", "20"}),
                   {"--marker-mm", "20 mm", "6.0 to 18.0"});
    expect_refusal(geometry({"--board", "9x7", "--square-mm", "20", "--marker-mm", "14"}),
                   {"--marker-mm", "found 14", "charuco:COLUMNSxROWS"});
    const auto board = [](std::vector<std::string> more) {
        std::vector<std::string> all = {"board", "--board", "9x7", "--square-mm"};
        all.insert(all.end(), more.begin(), more.end());
        return all;
    };
    expect_refusal(board({"25", "--out", "b.pdf"}), {"--square-mm", "found 25", "at most 21 for"});
    expect_refusal(board({"20", "--out", "b.png"}), {"--out", "b.png", ".pdf or .svg"});
    expect_refusal(board({"20", "--paper", "A9", "--out", "b.pdf"}), {"--paper", "A9", "letter"});
    expect_refusal(geometry({}), {"--throw-ratio", "found 0", "--board"});
    expect_refusal({"help", "nothing"}, {"\"nothing\"", "livery help"});
    expect_refusal({"plan", "--threads", "x"}, {"--threads", "\"x\"", "a whole number"});
    expect_refusal({"plan", "--budget-ms", "nan"}, {"--budget-ms", "\"nan\"", "finite"});
    expect_refusal({"plan", "--budget-ms", "-4"}, {"--budget-ms", "found -4", "milliseconds"});
    expect_refusal({"plan", "--design-white", "300"}, {"--design-white", "300", "0 to 100"});
    expect_refusal({"plan", "--stage", "paint"}, {"--stage", "\"paint\"", "radiance, projector"});
    expect_refusal({"calibrate", "color", "--captures", "a", "--out", "b", "--mode", "plain"},
                   {"--mode", "\"plain\"", "paper, robust", "livery help calibrate color"});
}

TEST(Messages, AWrongOutputNameFailsBeforeTheWork) {
    const TemporaryFolder folder;
    // Were the work done first, a missing calibration or look would be what is complained about.
    expect_refusal({"render", "--look", "none", "--out", "a.gif"}, {"a.gif", ".gif", ".png"});
    const std::string out = (folder / "a.png").string();
    expect_refusal({"render", "--projects", "b.png", "--out", out}, {"--projects", "reference"});
    expect_refusal({"render", "--projector", "b.json", "--out", out},
                   {"--projector", "--projects"});
    expect_refusal({"render", "--look", "none", "--out", "plain"}, {"plain", "none", ".png"});
    expect_refusal({"render", "--look", "none", "--out", (folder / "no/a.png").string()},
                   {"no/a.png", "folder"});
    expect_refusal({"compensate", "--calibration", "c", "--target", "t.exr", "--out", "a.jpg"},
                   {"a.jpg", ".jpg", ".png"});
}

TEST(Messages, APictureWithoutTheProductSaysSo) {
    const TemporaryFolder folder;
    write_camera_file(folder / "away.json",
                      look_at({0.0, 100.0, 400.0}, {0.0, 100.0, 900.0}, 0.4, 64, 48));
    const ProgramRun run = livery_run({"render",
                                       "--json",
                                       "--quality",
                                       "draft",
                                       "--camera",
                                       (folder / "away.json").string(),
                                       "--out",
                                       (folder / "a.png").string()});
    ASSERT_EQ(run.exit_code, 0) << run.err;
    EXPECT_EQ(Json::parse(run.out)["covered_fraction"], 0.0);
    EXPECT_NE(run.err.find("the picture is empty"), std::string::npos) << run.err;
}

TEST(Messages, CheckKnowsPatternsAndFoldersOfNothing) {
    const TemporaryFolder folder;
    const std::string patterns = (folder / "patterns").string();
    ASSERT_EQ(livery_run({"patterns", "--projector", "64x48", "--out", patterns}).exit_code, 0);
    const ProgramRun fresh = livery_run({"check", "--json", patterns});
    EXPECT_EQ(fresh.exit_code, 0) << fresh.err;
    EXPECT_EQ(Json::parse(fresh.out)["files"][0]["kind"], "patterns");
    std::filesystem::create_directories(folder / "empty");
    const ProgramRun empty = livery_run({"check", (folder / "empty").string()});
    EXPECT_EQ(empty.exit_code, 1);
    EXPECT_NE(empty.out.find("a calibration, geometry, pose, patterns or captures folder"),
              std::string::npos);
    // Photographing them over themselves would replace their manifest.
    expect_refusal({"photograph", "--size", "64x48", "--patterns", patterns, "--out", patterns},
                   {"--out", "--patterns"});
}

TEST(Messages, GrayCodeAloneIsNotEnoughForColour) {
    const TemporaryFolder folder;
    std::filesystem::create_directories(folder / "captures");
    const std::string source = (folder / "patterns").string();
    ASSERT_EQ(livery_run({"patterns", "--projector", "64x48", "--out", source}).exit_code, 0);
    for (int k = 0; k < 42; ++k) {
        char name[16];
        std::snprintf(name, sizeof name, "%02d.png", k);
        std::filesystem::copy_file(folder / "patterns/000.png", folder / "captures" / name);
    }
    expect_refusal({"calibrate",
                    "color",
                    "--captures",
                    (folder / "captures").string(),
                    "--out",
                    (folder / "out").string()},
                   {"42 Gray code photographs alone", "livery patterns"});
}

TEST(Messages, AFullOutputIsNoSuccess) {
    const std::string program = LIVERY_PROGRAM;
    const ProgramRun run = run_program("/bin/sh", {"-c", "'" + program + "' help >/dev/full"});
    EXPECT_EQ(run.exit_code, 2);
    EXPECT_NE(run.err.find("stdout"), std::string::npos) << run.err;
}

TEST(Messages, PlanNeedsNoHomeFolder) {
    const std::string program = LIVERY_PROGRAM;
    const ProgramRun run = run_program(
        "/usr/bin/env",
        {"-u", "HOME", "-u", "LIVERY_HOME", "-u", "XDG_DATA_HOME", program, "plan", "--json"});
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_EQ(Json::parse(run.out)["predicted_from"], "shipped");
}

TEST(Messages, PatternsHoldFringesWhereTheyAreAskedFor) {
    const TemporaryFolder folder;
    const auto roles_of = [&](const std::string& places) {
        const ProgramRun run = livery_run({"patterns",
                                           "--projector",
                                           "64x48",
                                           "--kind",
                                           "geometry",
                                           "--places",
                                           places,
                                           "--out",
                                           (folder / places).string(),
                                           "--json"});
        EXPECT_EQ(run.exit_code, 0) << run.err;
        std::vector<std::string> roles;
        const Json answer = Json::parse(run.out);
        for (const Json& one : answer["patterns"]) roles.push_back(one["role"].get<std::string>());
        return roles;
    };
    const auto gray = roles_of("gray"), both = roles_of("gray-and-phase");
    ASSERT_EQ(both.size(), gray.size() + 10);
    EXPECT_TRUE(std::equal(gray.begin(), gray.end(), both.begin()));
    EXPECT_EQ(both[gray.size()], "phase-column-0");
    EXPECT_EQ(both.back(), "phase-row-4");
}

TEST(Messages, WritingPatternsStopsAtOnce) {
    const TemporaryFolder folder;
    const pid_t child = ::fork();
    if (child == 0) {
        const std::string out = (folder / "patterns").string();
        if (!std::freopen("/dev/null", "w", stdout) || !std::freopen("/dev/null", "w", stderr))
            _exit(3);
        ::execl(LIVERY_PROGRAM,
                LIVERY_PROGRAM,
                "patterns",
                "--projector",
                "1920x1080",
                "--out",
                out.c_str(),
                nullptr);
        _exit(3);
    }
    ::sleep(1);
    ASSERT_EQ(::kill(child, SIGINT), 0);
    int status = 0;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    ASSERT_TRUE(WIFEXITED(status));
    EXPECT_EQ(WEXITSTATUS(status), 130);
    EXPECT_FALSE(std::filesystem::exists(folder / "patterns/manifest.json"));
}

}  // namespace
}  // namespace livery
