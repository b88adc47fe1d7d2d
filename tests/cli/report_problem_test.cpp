// livery report-problem, as somebody runs it where things are broken.
#include <filesystem>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "cli/livery_run.h"
#include "core/paths.h"

namespace livery {
namespace {

using Json = nlohmann::ordered_json;

/// In an environment of its own: no display, this home, and `more`.
ProgramRun report(const TemporaryFolder& home,
                  const std::vector<std::string>& arguments,
                  const std::vector<std::string>& more = {}) {
    std::vector<std::string> all = {"-u", "DISPLAY", "-u", "WAYLAND_DISPLAY", "-u", "LIVERY_HOME"};
    all.push_back("HOME=" + home.path().string());
    all.insert(all.end(), more.begin(), more.end());
    all.insert(all.end(), {LIVERY_PROGRAM, "report-problem", "--gl", "software"});
    all.insert(all.end(), arguments.begin(), arguments.end());
    return run_program("/usr/bin/env", all);
}

const Json* file_of(const Json& answer, const std::string& name) {
    for (const Json& file : answer["files"]) {
        if (file["name"] == name) return &file;
    }
    return nullptr;
}

TEST(ReportProblem, WritesAnArchiveWithoutDisplayHomeOrLog) {
    const TemporaryFolder home;
    const std::string out = (home / "report.zip").string();
    const ProgramRun run = report(home, {"--out", out, "--json"});
    ASSERT_EQ(run.exit_code, 0) << run.err;
    const Json answer = Json::parse(run.out);
    EXPECT_EQ(answer["file"], out);
    EXPECT_EQ(answer["bytes"], std::filesystem::file_size(out));
    EXPECT_EQ(answer["files"][0]["name"], "README.txt");
    for (const char* name : {"version.txt", "machine.txt", "opengl.txt", "cameras.txt"}) {
        const Json* file = file_of(answer, name);
        ASSERT_TRUE(file) << name;
        EXPECT_TRUE((*file)["problem"].is_null()) << *file;
        EXPECT_GT((*file)["bytes"], 0) << name;
    }
    for (const char* name : {"display.txt", "log.txt"}) {
        ASSERT_TRUE(file_of(answer, name)) << name;
        EXPECT_TRUE((*file_of(answer, name))["problem"].is_string()) << name;
    }
    for (const char* name : {"calibration.txt", "settings.json"}) {
        ASSERT_TRUE(file_of(answer, name)) << name;
        EXPECT_TRUE((*file_of(answer, name))["problem"].is_null()) << "not there yet is no fault";
    }
    for (const char* name : {"session.json", "votes/rounds.txt"})
        EXPECT_FALSE(file_of(answer, name));
    EXPECT_EQ(run.out.find("USER="), std::string::npos);
    const ProgramRun opened = run_program("python3", {"-m", "zipfile", "-t", out});
    EXPECT_EQ(opened.exit_code, 0) << opened.err;
}

TEST(ReportProblem, TellsOfASessionOnlyWhereItIsNamed) {
    const TemporaryFolder home;
    const std::string session = (home / "show.livery").string(), out = (home / "r.zip").string();
    ASSERT_EQ(livery_run({"session", "new", session, "--product", "sphere"}).exit_code, 0);
    const ProgramRun run = report(
        home, {"--out", out, "--json", "--session", session, "--with-pictures", "--with-votes"});
    ASSERT_EQ(run.exit_code, 0) << run.err;
    const Json answer = Json::parse(run.out);
    for (const char* name : {"session.json", "votes/rounds.txt"}) {
        ASSERT_TRUE(file_of(answer, name)) << name;
        EXPECT_TRUE((*file_of(answer, name))["problem"].is_null()) << name;
    }
    ASSERT_EQ(run_program("python3", {"-m", "zipfile", "-e", out, (home / "o").string()}).exit_code,
              0);
    EXPECT_EQ(Json::parse(read_text_file(home / "o/session.json"))["product"], "sphere");
    EXPECT_NE(read_text_file(home / "o/calibration.txt").find("no calibration"), std::string::npos);
}

TEST(ReportProblem, PrintsOnePartAlone) {
    const TemporaryFolder home;
    const ProgramRun run = report(home, {"--show", "opengl"});
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_NE(run.out.find("Renderer: "), std::string::npos) << run.out;
    const ProgramRun display = report(home, {"--show", "display"});
    EXPECT_EQ(display.exit_code, 2) << display.out;
    EXPECT_NE(display.err.find("display"), std::string::npos) << display.err;
}

TEST(ReportProblem, RefusesWhatItCannotDo) {
    const TemporaryFolder home;
    const auto refused = [&](const std::vector<std::string>& arguments, const std::string& part) {
        const ProgramRun run = report(home, arguments);
        EXPECT_EQ(run.exit_code, 2) << run.out;
        EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
        EXPECT_NE(run.err.find(part), std::string::npos) << run.err;
    };
    refused({"--out", (home / "report.tar").string()}, ".zip");
    refused({"--out", "/proc/report.zip"}, "/proc");
    refused({"--out", (home / "no/report.zip").string()}, "--out");
    refused({"--session", (home / "none.livery").string()}, "no such file");
    refused({"--show", "votes"}, "opengl, display, cameras");
    EXPECT_TRUE(std::filesystem::is_empty(home.path())) << "nothing is left behind";
}

}  // namespace
}  // namespace livery
