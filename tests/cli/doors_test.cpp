// What the program does before it works: where it may write, what it may read, whom it answers.

#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "cli/livery_run.h"
#include "core/channels.h"
#include "core/image_io.h"
#include "core/paths.h"

namespace livery {
namespace {

using Json = nlohmann::ordered_json;

/// Through a shell, which can close what a program cannot.
ProgramRun shell_run(const std::filesystem::path& folder, const std::string& command) {
    return run_program("sh",
                       {"-c", "cd '" + folder.string() + "' && " + LIVERY_PROGRAM + " " + command});
}

bool says(const ProgramRun& run, const std::string& part) {
    return run.err.find(part) != std::string::npos;
}

TEST(Doors, AClosedAnswerIsFoundBeforeTheWork) {
    const TemporaryFolder folder;
    const std::string file = (folder / "show.livery").string();
    ASSERT_EQ(livery_run({"session", "new", file, "--product", "sphere"}).exit_code, 0);
    const std::string apply =
        "session apply show.livery --command '{\"set-exposure\": {\"ev\": 2}}' >&-";
    const ProgramRun run = shell_run(folder.path(), apply);
    EXPECT_EQ(run.exit_code, 2);
    EXPECT_TRUE(says(run, "stdout: found it closed")) << run.err;
    const ProgramRun shown = livery_run({"session", "show", "--json", file});
    EXPECT_EQ(Json::parse(shown.out)["undo_steps"], 0) << "nothing was done";
}

TEST(Doors, CommonOptionsMayComeFirst) {
    const ProgramRun first = livery_run(
        {"--json", "--seed", "3", "--gl=auto", "albedo", "--material", "solid red", "--mu", "1"});
    const ProgramRun last = livery_run(
        {"albedo", "--material", "solid red", "--mu", "1", "--json", "--seed", "3", "--gl=auto"});
    EXPECT_EQ(first.exit_code, 0) << first.err;
    EXPECT_EQ(first.out, last.out);
    EXPECT_TRUE(Json::accept(first.out));
    const ProgramRun group = livery_run({"--json", "session", "show", "none.livery"});
    EXPECT_TRUE(says(group, "none.livery")) << group.err;
}

TEST(Doors, WhatLiesInTheFolderDoesNotShadowWhatIsShipped) {
    const TemporaryFolder folder;
    for (const char* name : {"sphere", "default", "solid-red", "car"}) {
        std::filesystem::create_directory(folder / name);
    }
    folder.write("solid red", "junk");
    const ProgramRun plan = shell_run(folder.path(), "plan --product sphere --look solid-red");
    EXPECT_EQ(plan.exit_code, 0) << plan.err;
    const ProgramRun albedo = shell_run(folder.path(), "albedo --material 'solid red' --mu 1");
    EXPECT_EQ(albedo.exit_code, 0) << albedo.err;
    const ProgramRun bench =
        shell_run(folder.path(), "photograph --bench default --patterns none --out out");
    EXPECT_TRUE(says(bench, "none/manifest.json")) << bench.err;
}

TEST(Doors, AnOutputThatCannotBeWrittenIsFoundBeforeTheWork) {
    // Were the work begun first, the inputs that are not there would be complained about.
    const TemporaryFolder folder;
    folder.write("file", "mine");
    const std::string below_file = (folder / "file/out").string();
    const std::string nowhere = (folder / "no/out").string(), a_folder = folder.path().string();
    const std::vector<std::vector<std::string>> files = {
        {"render", "--look", "none"},
        {"compensate", "--calibration", "none", "--target", "none"},
        {"brdf", "--material", "none", "--in", "none"},
        {"fit", "brdf", "--measured", "none"},
        {"measure", "brdf", "--captures", "none"},
        {"measure", "profile", "--captures", "none"},
        {"paints", "none", "--tint", "none"},
        {"session", "export", "none", "--look", "1"},
        {"session", "render", "none", "--look", "1"}};
    for (std::vector<std::string> arguments : files) {
        for (const std::string& out : {nowhere, below_file, a_folder}) {
            std::vector<std::string> all = arguments;
            all.insert(all.end(), {"--out", out});
            const ProgramRun run = livery_run(all);
            EXPECT_EQ(run.exit_code, 2);
            EXPECT_TRUE(says(run, "--out")) << all[0] << " " << out << ": " << run.err;
        }
    }
    const std::vector<std::vector<std::string>> folders = {
        {"calibrate", "color", "--captures", "none"},
        {"photograph", "--patterns", "none"},
        {"patterns", "--projector", "64x32"},
        {"demo"},
        {"bench", "--quick"}};
    for (std::vector<std::string> arguments : folders) {
        for (const std::string& out :
             {below_file, below_file + "/deep", (folder / "file").string()}) {
            std::vector<std::string> all = arguments;
            all.insert(all.end(), {"--out", out});
            const ProgramRun run = livery_run(all);
            EXPECT_EQ(run.exit_code, 2);
            EXPECT_TRUE(says(run, "--out")) << all[0] << " " << out << ": " << run.err;
        }
    }
    EXPECT_EQ(read_text_file(folder / "file"), "mine");
}

TEST(Doors, ChannelsOfAnotherMeaningAreNoColours) {
    const TemporaryFolder folder;
    const auto channels_of = [&](std::vector<std::string> names) {
        write_exr(folder / "a.exr", ImageF(4, 4, static_cast<int>(names.size())), names);
        return colour_channels(folder / "a.exr", read_image(folder / "a.exr"));
    };
    EXPECT_EQ(channels_of({"R", "G", "B"}), (std::array{0, 1, 2}));
    EXPECT_EQ(channels_of({"Y"}), (std::array{0, 0, 0}));
    for (const std::vector<std::string>& names : std::vector<std::vector<std::string>>{
             {"X", "Y", "Z"}, {"Z"}, {"X", "Y"}, {"U", "V", "W"}}) {
        EXPECT_ANY_THROW(channels_of(names)) << names[0];
    }
}

TEST(Doors, CheckSaysWhichFilesLieElsewhere) {
    const TemporaryFolder folder;
    std::filesystem::create_directory(folder / "captures");
    write_png(folder / "far.png", Image8(8, 6, 3, 9));
    write_png(folder / "captures/near.png", Image8(8, 6, 3, 9));
    folder.write("captures/manifest.json", R"({"projector": [8, 6], "captures": [
        {"file": "near.png", "role": "white", "exposure_s": 1},
        {"file": "../far.png", "role": "black", "exposure_s": 1}]})");
    const ProgramRun run = livery_run({"check", (folder / "captures").string()});
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_NE(run.out.find("far.png, which lies elsewhere"), std::string::npos) << run.out;
    EXPECT_EQ(run.out.find("near.png"), std::string::npos) << run.out;
}

TEST(Doors, LongNamesAreCutOff) {
    const std::string name(100'000, 'a');
    for (const std::vector<std::string>& arguments : std::vector<std::vector<std::string>>{
             {name}, {"plan", "--look", name}, {"plan", "--product", name}, {"help", name}}) {
        const ProgramRun run = livery_run(arguments);
        EXPECT_EQ(run.exit_code, 2);
        EXPECT_LT(run.err.size(), 5000u);
    }
}

}  // namespace
}  // namespace livery
