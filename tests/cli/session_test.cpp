// `livery session`: the desktop's commands for scripts.

#include "session/session.h"

#include <set>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "cli/session_run.h"

namespace livery {
namespace {

constexpr const char* kPaint =
    R"({"set-paint": {"look": 1, "part": "body", "paint": "solid-red"}})";
constexpr const char* kEdit =
    R"({"edit-paint": {"look": 1, "part": "body", "material": {"name": "solid red", "model":
        "lambert", "parameters": {"diffuse": [0.5, 0.25, 0.1]}}}})";

TEST(SessionCommand, AppliesUndoesAndRedoes) {
    const TemporaryFolder folder;
    const auto file = folder / "eine Sitzung äöü.livery";
    const Json first = answer(session_run("new", file));
    EXPECT_EQ(first["document"]["looks"].size(), 4u);
    EXPECT_EQ(first["undo_steps"], 0);
    EXPECT_TRUE(first["undo"].is_null());
    Json now = answer(session_run(
        "apply", file, {"--command", kPaint, "--command", R"({"set-exposure": {"ev": 0.5}})"}));
    EXPECT_EQ(now["document"]["looks"][0]["parts"]["body"], "solid red");
    EXPECT_EQ(now["undo_steps"], 2);
    EXPECT_EQ(now["undo"], "Set exposure to 0.5 EV");
    now = answer(session_run("undo", file, {"--steps", "2"}));
    EXPECT_EQ(now["document"], first["document"]);
    EXPECT_EQ(now["redo_steps"], 2);
    now = answer(session_run("redo", file));
    EXPECT_EQ(now["undo"], "Paint body solid red");
    EXPECT_EQ(answer(session_run("show", file)), now);
    EXPECT_EQ(run_program(LIVERY_PROGRAM, {"check", file.string()}).exit_code, 0);
}

TEST(SessionCommand, DoesAllOrNothing) {
    const TemporaryFolder folder;
    const auto file = folder / "a.livery";
    const Json before = answer(session_run("new", file));
    const ProgramRun wrong = session_run(
        "apply", file, {"--command", kPaint, "--command", R"({"delete-look": {"look": 7}})"});
    EXPECT_EQ(wrong.exit_code, 2);
    EXPECT_NE(wrong.err.find("there is no look 7"), std::string::npos) << wrong.err;
    EXPECT_EQ(answer(session_run("show", file)), before);
    answer(session_run("apply", file, {"--command", kPaint}));
    const ProgramRun far = session_run("undo", file, {"--steps", "2"});
    EXPECT_EQ(far.exit_code, 1);
    EXPECT_NE(far.out.find("fewer than 2 steps to undo"), std::string::npos) << far.out;
    EXPECT_EQ(answer(session_run("show", file))["undo_steps"], 1);
}

TEST(SessionCommand, SaysWhatIsWrong) {
    const TemporaryFolder folder;
    const auto file = folder / "a.livery";
    const auto says = [](const ProgramRun& run, int exit_code, const std::string& text) {
        EXPECT_EQ(run.exit_code, exit_code) << run.err;
        EXPECT_NE((run.out + run.err).find(text), std::string::npos) << run.out << run.err;
    };
    for (const char* name : {"show", "undo", "redo"}) {
        says(session_run(name, file), 2, "a.livery: found no such file");
    }
    says(session_run("apply", file, {"--command", kPaint}), 2, "livery session new makes one");
    EXPECT_FALSE(std::filesystem::exists(file));
    answer(session_run("new", file));
    says(session_run("new", file), 1, "is there already");
    says(session_run("apply", file, {"--command", "{\"set-"}), 2, "--command: line 1");
    says(session_run("apply", file), 2, "--command");
    says(session_run("undo", file, {"--steps", "0"}), 2, "--steps: found 0, expected 1 or more");
    says(session_run("export", file, {"--look", "9", "--out", "x.json"}), 2, "there is no look 9");
    const auto product = [&](const char* look, const char* out) {
        return session_run("export-product", file, {"--look", look, "--out", out});
    };
    says(product("9", "x.glb"), 2, "there is no look 9");
    says(product("1", "x.obj"), 2, "ends in .glb");
    says(session_run("import", file, {"--look-file", "/no.json"}), 2, "/no.json: found no such");
    says(session_run("render", file, {"--look", "1", "--out", "x.gif"}), 2, ".gif");
    says(session_run("render", file, {"--look", "1", "--out", "x.png", "--stage", "projector"}),
         1,
         "no calibration to correct with");
    const auto text = folder.write("text.livery", std::string(5000, 'x'));
    says(session_run("show", text), 2, "text.livery: found a file that is not a database");
    says(run_program(LIVERY_PROGRAM, {"session", "sing"}), 2, "session sing");
}

TEST(SessionCommand, IsRefusedWhileTheDesktopHasTheFile) {
    const TemporaryFolder folder;
    const auto file = folder / "a.livery";
    const Session desktop = Session::open(file);
    const ProgramRun refused = session_run("apply", file, {"--command", kPaint});
    EXPECT_EQ(refused.exit_code, 1);
    const Json no = Json::parse(refused.out)["refused"][0];
    EXPECT_EQ(
        no["why"],
        file.string() + " is open in another Livery (process " + std::to_string(::getpid()) + ")");
    EXPECT_EQ(no["fix"], "close it there, or name another session file here");
    EXPECT_EQ(answer(session_run("show", file))["undo_steps"], 0);
}

TEST(SessionCommand, ExportedLookComesBackWithItsOwnPaints) {
    const TemporaryFolder folder;
    const auto file = folder / "a.livery";
    answer(session_run("new", file));
    answer(session_run("apply", file, {"--command", kPaint, "--command", kEdit}));
    const auto look = folder / "mein Look.json";
    const Json files = answer(session_run("export", file, {"--look", "1", "--out", look.string()}));
    ASSERT_EQ(files["files"].size(), 2u);
    EXPECT_EQ(files["files"][1], (folder / "mein Look solid red 2.json").string());
    EXPECT_EQ(run_program(LIVERY_PROGRAM, {"check", files["files"][1]}).exit_code, 0);
    const auto other = folder / "b.livery";
    answer(session_run("new", other));
    const Json with = answer(session_run("import", other, {"--look-file", look.string()}));
    const Json& imported = with["document"]["looks"][4];
    EXPECT_EQ(imported["name"], "blue metallic 2");
    EXPECT_EQ(imported["parts"]["body"], files["files"][1]);
}

TEST(SessionCommand, ExportedProductWearsTheSessionsLooks) {
    const TemporaryFolder folder;
    const auto file = folder / "a.livery", product = folder / "player looks.glb";
    answer(session_run("new", file, {"--product", "player"}));
    const Json looks = answer(session_run("show", file))["document"]["looks"];
    EXPECT_EQ(answer(session_run(
                  "export-product", file, {"--look", "1", "--out", product.string()}))["file"],
              product.string());
    const auto other = folder / "b.livery";
    const Json again =
        answer(session_run("new", other, {"--product", product.string()}))["document"]["looks"];
    std::set<std::string> names;
    for (const Json& look : again) names.insert(look["name"].get<std::string>());
    // Beside the shipped ones, which have the names.
    for (const Json& look : looks) {
        EXPECT_TRUE(names.contains(look["name"].get<std::string>() + " of the file")) << look;
    }
}

}  // namespace
}  // namespace livery
