// The program as its users meet it: real commands, real files, small pictures.

#include <algorithm>
#include <cmath>
#include <csignal>
#include <fstream>
#include <functional>
#include <sstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sys/types.h>
#include <unistd.h>

#include "cli/livery_run.h"
#include "core/image_io.h"
#include "scene/view.h"

namespace livery {
namespace {

using Json = nlohmann::ordered_json;

Json json_of(const ProgramRun& run) {
    const Json json = Json::parse(run.out, nullptr, false);
    EXPECT_FALSE(json.is_discarded()) << run.out << run.err;
    return json;
}

std::string content(const std::filesystem::path& file) {
    std::stringstream text;
    text << std::ifstream(file).rdbuf();
    return text.str();
}

/// A small picture of the car from the side.
std::string small_camera(const TemporaryFolder& folder) {
    const auto file = folder / "small camera.json";
    write_camera_file(file, look_at({-120.0, 150.0, 380.0}, {0.0, 25.0, 0.0}, 0.4, 160, 100));
    return file.string();
}

/// The default bench with a quarter of the pixels a side.
std::string small_bench(const TemporaryFolder& folder) {
    return folder
        .write("small bench.json",
               R"({"format_version": 1, "kind": "bench", "name": "small", "base": "default.json",
                   "projector": {"width": 320, "height": 200, "at_px": [160, 101],
                                 "matrix": [882.5, 0, 160, 0, 882.5, 190.5, 0, 0, 1]},
                   "camera": {"width": 432, "height": 288, "at_px": [216, 145],
                              "matrix": [1225, 0, 216.5, 0, 1225, 143, 0, 0, 1]}})")
        .string();
}

TEST(Program, HelpNamesEveryCommandAndEachHasAnExample) {
    const ProgramRun all = livery_run({"help"});
    EXPECT_EQ(all.exit_code, 0);
    for (const char* name : {"demo",
                             "render",
                             "plan",
                             "brdf",
                             "albedo",
                             "paints",
                             "patterns",
                             "photograph",
                             "capture",
                             "calibrate color",
                             "calibrate register",
                             "calibrate scan",
                             "measure brdf",
                             "measure profile",
                             "fit brdf",
                             "compensate",
                             "check",
                             "bench",
                             "evaluate order",
                             "evaluate tally",
                             "session apply"}) {
        EXPECT_NE(all.out.find(name), std::string::npos) << name;
        const ProgramRun one = livery_run({"help", name});
        EXPECT_EQ(one.exit_code, 0) << name;
        EXPECT_NE(one.out.find(std::string("livery ") + name), std::string::npos) << name;
        EXPECT_NE(one.out.find("Example:"), std::string::npos) << name;
    }
    EXPECT_EQ(livery_run({"--version"}).out.substr(0, 7), "livery ");
}

TEST(Program, WrongArgumentsGiveOneLineAndStatusTwo) {
    const std::vector<std::vector<std::string>> wrong = {
        {"evaluate"},
        {"demo", "--size", "12"},
        {"demo", "--bench", "/nowhere/bench.json"},
        {"demo", "--product", "boat"},
        {"render", "--out", "a.jpg", "--backend", "vulkan"},
        {"render"},
        {"render", "--look", "no such look", "--out", "a.png"},
        {"render", "--look", "/nowhere.json", "--out", "a.png"},
        {"render", "--product", "/nowhere.glb", "--out", "a.png"},
        {"render", "--eye", "1,2", "--out", "a.png"},
        {"render", "--stage", "projector", "--out", "a.png"},
        {"render", "--quality", "draft", "--budget-ms", "5", "--out", "a.png"},
        {"render", "--spp", "4", "--out", "a.png"},
        {"patterns", "--projector", "1280", "--out", "a"},
        {"patterns", "--projector", "64x48", "--out", "a", "--places", "phase"},
        {"patterns", "--projector", "64x48", "--dark", "9", "--bright", "9", "--out", "a"},
        {"calibrate", "color", "--captures", "/nowhere", "--out", "a"},
        {"photograph", "--out", "a"},
        {"photograph", "--patterns", "a", "--sphere", "solid red", "--out", "b"},
        {"photograph", "--sphere", "no such paint", "--out", "a"},
        {"photograph", "--sphere", "solid red", "--exposure-s", "1", "--out", "a"},
        {"measure", "brdf", "--captures", "/nowhere", "--out", "a.csv"},
        {"measure", "brdf", "--captures", "/nowhere", "--out", "a.binary"},
        {"measure", "profile", "--captures", "/nowhere", "--out", "a.csv"},
        {"measure", "profile", "--captures", "/nowhere", "--out", "a.json"},
        {"measure", "profile", "--captures", "/nowhere", "--eta", "0", "--out", "a.csv"},
        {"photograph", "--spot", "no such stone", "--out", "a"},
        {"photograph", "--spot", "marble", "--size", "64x32", "--out", "a"},
        {"photograph", "--spot", "marble", "--exposure-s", "1", "--out", "a"},
        {"compensate", "--calibration", "/nowhere", "--target", "a.exr", "--out", "a.png"},
        {"bench", "--markdown", "/nowhere/page.md"},
        {"bench", "--suite", "taste"}};
    for (const auto& words : wrong) {
        const ProgramRun run = livery_run(words);
        EXPECT_EQ(run.exit_code, 2) << words[0] << ": " << run.err;
        EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
        EXPECT_TRUE(run.out.empty()) << run.out;
    }
}

TEST(Program, ShippedFilesPassTheCheck) {
    std::vector<std::string> arguments = {"check", "--json"};
    for (const char* folder : {"materials", "assets/looks", "calibration"}) {
        for (const auto& entry :
             std::filesystem::directory_iterator(std::filesystem::path(LIVERY_SOURCE) / folder)) {
            if (entry.path().extension() == ".json") arguments.push_back(entry.path().string());
        }
    }
    ASSERT_GT(arguments.size(), 20u);
    const ProgramRun run = livery_run(arguments);
    EXPECT_EQ(run.exit_code, 0) << run.out;
    for (const auto& file : json_of(run)["files"]) {
        EXPECT_TRUE(file["ok"]) << file.dump();
        EXPECT_NE(file["kind"], "unknown") << file.dump();
    }
}

TEST(Program, CheckSaysWhatIsWrong) {
    const TemporaryFolder folder;
    const auto broken = folder.write("broken.json", "{\"model\": ");
    const auto strange = folder.write("strange.xyz", "hello");
    const ProgramRun run = livery_run(
        {"check", "--json", broken.string(), strange.string(), (folder / "missing.glb").string()});
    EXPECT_EQ(run.exit_code, 1);
    const Json files = json_of(run)["files"];
    ASSERT_EQ(files.size(), 3u);
    EXPECT_NE(files[0]["problems"][0].get<std::string>().find("not JSON"), std::string::npos);
    EXPECT_NE(files[1]["problems"][0].get<std::string>().find(".xyz"), std::string::npos);
    EXPECT_NE(files[2]["problems"][0].get<std::string>().find("no such file"), std::string::npos);
}

TEST(Program, CheckNeitherFloodsNorSteersATerminal) {
    const TemporaryFolder folder;
    Json json =
        Json::parse(R"({"asset": {"version": "2.0"}, "extensionsUsed": [], "scenes": [{}]})");
    for (int k = 0; k < 500; ++k)
        json["extensionsUsed"].push_back("EXT_\x1b[2J" + std::to_string(k));
    const auto file = folder.write("many.gltf", json.dump());
    const auto named = folder.write("\x1b[31mred.json", "{}");
    const ProgramRun run = livery_run({"check", file.string(), named.string()});
    EXPECT_LT(run.out.size(), 6000u) << run.out;
    EXPECT_EQ(run.out.find('\x1b'), std::string::npos);
}

TEST(Program, WhoGivesAFileAloneIsToldWhatOpensIt) {
    for (const char* file : {"roadster.livery", "car.glb"}) {
        const ProgramRun run = livery_run({file});
        EXPECT_EQ(run.exit_code, 2);
        EXPECT_NE(run.err.find("livery desktop opens a session or a mesh"), std::string::npos)
            << run.err;
    }
    EXPECT_EQ(livery_run({"rendre"}).err.find("livery desktop"), std::string::npos);
}

TEST(Program, ScansAreProductsAndTellWhatWasAssumed) {
    const TemporaryFolder folder;
    const auto scan = folder
                          .write("my scan.obj",
                                 "v -60 0 0\nv 60 0 0\nv 60 60 0\nv -60 60 0\n"
                                 "usemtl wing\nf 1 2 3 4\n")
                          .string();
    const auto picture = (folder / "scan.png").string();
    const ProgramRun run =
        livery_run({"render", "--product", scan, "--out", picture, "--json", "--threads", "1"});
    ASSERT_EQ(run.exit_code, 0) << run.err;
    const Json figures = json_of(run);
    EXPECT_GT(figures["covered_fraction"], 0.05);
    ASSERT_EQ(figures["notes"].size(), 2u) << run.out;
    EXPECT_NE(run.err.find("note: the file states no unit; its longest side of 120 is taken as"),
              std::string::npos);

    const Json asked = json_of(
        livery_run({"plan", "--product", scan, "--unit", "in", "--json", "--quality", "draft"}));
    EXPECT_EQ(asked["notes"].size(), 1u) << asked.dump();
    const ProgramRun unknown = livery_run({"plan", "--product", scan, "--unit", "ell"});
    EXPECT_EQ(unknown.exit_code, 2);
    EXPECT_NE(unknown.err.find("--unit: found \"ell\", expected mm, cm, m, in"), std::string::npos);

    const ProgramRun check = livery_run({"check", scan});
    EXPECT_EQ(check.exit_code, 0);
    EXPECT_NE(check.out.find("ok      mesh: "), std::string::npos);
    EXPECT_NE(check.out.find("note: no normals; computed"), std::string::npos);
}

TEST(Program, RendersBothBackendsAndPlans) {
    const TemporaryFolder folder;
    const std::string camera = small_camera(folder);
    const auto picture = folder / "a look.png";
    const ProgramRun gl = livery_run({"render",
                                      "--json",
                                      "--camera",
                                      camera,
                                      "--look",
                                      "blue-metallic",
                                      "--out",
                                      picture.string()});
    ASSERT_EQ(gl.exit_code, 0) << gl.err;
    EXPECT_GT(std::filesystem::file_size(picture), 1000u);
    const Json figures = json_of(gl);
    EXPECT_GT(figures["ms_total"].get<double>(), 0.0);
    for (const auto& pass : figures["passes"]) {
        EXPECT_FALSE(pass["why"].get<std::string>().empty());
        EXPECT_TRUE(pass["ms"].is_number()) << pass.dump();
    }
    for (const auto& pass : figures["skipped"])
        EXPECT_FALSE(pass["why"].get<std::string>().empty());

    const ProgramRun reference = livery_run({"render",
                                             "--json",
                                             "--camera",
                                             camera,
                                             "--look",
                                             "blue-metallic",
                                             "--backend",
                                             "reference",
                                             "--spp",
                                             "2",
                                             "--out",
                                             (folder / "truth.exr").string()});
    ASSERT_EQ(reference.exit_code, 0) << reference.err;
    EXPECT_EQ(json_of(reference)["spp"], 2);
    EXPECT_EQ(json_of(reference)["mean_spp"], 2.0);
    // What is known of each pixel stands beside it, and the picture is still one for others.
    const ImageFile truth = read_image(folder / "truth.exr");
    const auto channel = [&](const std::string& name) {
        const auto found = std::ranges::find(truth.channel_names, name);
        EXPECT_NE(found, truth.channel_names.end()) << name;
        return static_cast<std::size_t>(found - truth.channel_names.begin());
    };
    const std::size_t variance = channel("variance.Y"), confidence = channel("confidence.Y"),
                      samples = channel("samples.Y"), alpha = channel("A");
    int sure = 0;
    for (std::size_t i = 0; i < truth.image.pixel_count(); ++i) {
        const float* v =
            truth.image.values.data() + i * static_cast<std::size_t>(truth.image.channels);
        EXPECT_EQ(v[samples], 2.0f);
        if (v[alpha] < 1.0f) continue;
        // Student's t of one degree of freedom
        EXPECT_NEAR(v[confidence], 12.706f * std::sqrt(v[variance]), 1e-4f * v[confidence]);
        sure += v[confidence] > 0.0f ? 1 : 0;
    }
    EXPECT_GT(sure, 100);
    EXPECT_EQ(livery_run({"check", (folder / "truth.exr").string()}).exit_code, 0);

    // On a machine where nothing was ever timed, costs that come with the program predict.
    const auto plan = [&] {
        const ProgramRun run = livery_run({"plan", "--json", "--camera", camera});
        EXPECT_EQ(run.exit_code, 0) << run.err;
        return json_of(run);
    };
    ::setenv("LIVERY_HOME", (folder / "home").c_str(), 1);
    const auto shipped = plan();
    EXPECT_EQ(shipped["predicted_from"], "shipped");
    EXPECT_GT(shipped["predicted_ms_total"].get<double>(), 0.0);
    EXPECT_GT(shipped["predicted_error"].get<double>(), 0.0);
    for (const auto& pass : shipped["passes"]) {
        EXPECT_GT(pass["predicted_ms"].get<double>(), 0.0) << pass;
    }
    EXPECT_EQ(livery_run(
                  {"render", "--camera", camera, "--budget-ms", "60000", "--out", picture.string()})
                  .exit_code,
              0);
    ASSERT_EQ(livery_run({"bench", "--suite", "costs", "--quick"}).exit_code, 0);
    EXPECT_EQ(plan()["predicted_from"], "scaled");
}

TEST(Program, GoesFromPatternsToProjectorInputThroughFiles) {
    const TemporaryFolder folder;
    const std::string patterns = (folder / "patterns").string();
    const std::string captures = (folder / "captures").string();
    const std::string calibration = (folder / "calibration").string();
    ASSERT_EQ(livery_run({"patterns", "--projector", "320x200", "--out", patterns}).exit_code, 0);
    // Nobody has photographed these yet.
    const ProgramRun early =
        livery_run({"calibrate", "color", "--captures", patterns, "--out", calibration});
    EXPECT_EQ(early.exit_code, 2);
    EXPECT_NE(early.err.find("exposure_s"), std::string::npos) << early.err;

    const ProgramRun taken = livery_run(
        {"photograph", "--bench", small_bench(folder), "--patterns", patterns, "--out", captures});
    ASSERT_EQ(taken.exit_code, 0) << taken.err;
    const ProgramRun solved = livery_run({"calibrate",
                                          "color",
                                          "--json",
                                          "--captures",
                                          captures,
                                          "--camera-to-xyz",
                                          captures + "/camera-to-xyz.json",
                                          "--camera",
                                          captures + "/projector.json",
                                          "--out",
                                          calibration});
    ASSERT_EQ(solved.exit_code, 0) << solved.err;
    // Kept with the calibration, and refused before the work when it is of another projector.
    EXPECT_EQ(content(calibration + "/projector.json"), content(captures + "/projector.json"));
    const std::string full_size = captures + "/../full-size.json";
    Json view = Json::parse(content(captures + "/projector.json"));
    view["width"] = 640;
    std::ofstream(full_size) << view.dump();
    const ProgramRun other = livery_run({"calibrate",
                                         "color",
                                         "--captures",
                                         captures,
                                         "--camera",
                                         full_size,
                                         "--out",
                                         (folder / "none").string()});
    EXPECT_EQ(other.exit_code, 2);
    EXPECT_NE(other.err.find("640 x 200"), std::string::npos) << other.err;
    EXPECT_FALSE(std::filesystem::exists(folder / "none"));
    const Json figures = json_of(solved);
    EXPECT_GT(figures["valid_fraction"].get<double>(), 0.8);
    EXPECT_LT(figures["additivity_error"].get<double>(), 0.02);
    const ProgramRun checked = livery_run({"check", calibration, captures});
    EXPECT_EQ(checked.exit_code, 0);
    EXPECT_NE(checked.out.find("note: of the lit pixels "), std::string::npos) << checked.out;

    // For a product it is that one's: another one is refused, unless somebody insists.
    const auto of_car = [&](std::vector<std::string> words) {
        words.insert(words.begin(), {"calibrate", "color", "--captures", captures});
        words.insert(words.end(), {"--product", "car", "--out", (folder / "of car").string()});
        return livery_run(words);
    };
    const ProgramRun nowhere = of_car({});
    EXPECT_EQ(nowhere.exit_code, 2);
    EXPECT_NE(nowhere.err.find("--product: found no --camera"), std::string::npos) << nowhere.err;
    ASSERT_EQ(of_car({"--camera", captures + "/projector.json"}).exit_code, 0);
    std::vector<std::string> another = {"render",
                                        "--product",
                                        "sphere",
                                        "--quality",
                                        "draft",
                                        "--calibration",
                                        (folder / "of car").string(),
                                        "--out",
                                        (folder / "another.exr").string()};
    const ProgramRun refused = livery_run(another);
    EXPECT_EQ(refused.exit_code, 1);
    EXPECT_NE(refused.err.find("made for Car, not for Sphere"), std::string::npos) << refused.err;
    another.emplace_back("--anyway");
    EXPECT_EQ(livery_run(another).exit_code, 0);

    // What role, size and drive say needs no pattern file.
    const auto calibrated_with = [&](const std::function<void(Json&)>& change) {
        Json manifest = Json::parse(content(captures + "/manifest.json"));
        for (Json& entry : manifest["captures"]) {
            change(entry);
            entry["file"] = captures + "/" + entry["file"].get<std::string>();
        }
        std::filesystem::create_directories(folder / "moved");
        std::ofstream(folder / "moved" / "manifest.json") << manifest.dump();
        return livery_run({"calibrate",
                           "color",
                           "--json",
                           "--captures",
                           (folder / "moved").string(),
                           "--camera-to-xyz",
                           captures + "/camera-to-xyz.json",
                           "--out",
                           (folder / "moved calibration").string()});
    };
    const ProgramRun moved =
        calibrated_with([](Json& entry) { entry["pattern"] = "gone/pattern.png"; });
    ASSERT_EQ(moved.exit_code, 0) << moved.err;
    EXPECT_EQ(json_of(moved)["valid_fraction"], figures["valid_fraction"]);
    EXPECT_EQ(json_of(moved)["response"], figures["response"]);
    const std::string warned = json_of(moved)["warnings"].dump();
    EXPECT_NE(warned.find("the pattern of gray-levels"), std::string::npos) << warned;
    EXPECT_EQ(warned.find("the pattern of red"), std::string::npos) << warned;
    // Without its drive nothing says how bright it was.
    const ProgramRun unknown = calibrated_with([](Json& entry) {
        if (entry["role"] != "bright-gray") return;
        entry["pattern"] = "gone/pattern.png";
        entry.erase("drive");
    });
    EXPECT_EQ(unknown.exit_code, 2);
    EXPECT_NE(unknown.err.find("gone/pattern.png"), std::string::npos) << unknown.err;

    write_camera_file(folder / "camera.json",
                      look_at({-120.0, 150.0, 380.0}, {0.0, 25.0, 0.0}, 0.4, 320, 200));
    const std::string wanted = (folder / "wanted.exr").string();
    ASSERT_EQ(livery_run({"render", "--camera", (folder / "camera.json").string(), "--out", wanted})
                  .exit_code,
              0);
    // Without coverage a table counts for the design white too, and the answer says so.
    ImageFile bare = read_image(wanted);
    ImageF colour(bare.image.width, bare.image.height, 3);
    for (std::size_t i = 0; i < colour.pixel_count(); ++i) {
        std::copy_n(bare.image.values.begin() + static_cast<std::ptrdiff_t>(4 * i),
                    3,
                    colour.values.begin() + static_cast<std::ptrdiff_t>(3 * i));
    }
    write_exr(folder / "bare.exr", colour, {"R", "G", "B"});
    const auto compensated = [&](const std::string& target) {
        return livery_run({"compensate",
                           "--json",
                           "--calibration",
                           calibration,
                           "--target",
                           target,
                           "--out",
                           (folder / "input.png").string()});
    };
    const ProgramRun covered = compensated(wanted),
                     uncovered = compensated((folder / "bare.exr").string());
    ASSERT_EQ(covered.exit_code, 0) << covered.err;
    ASSERT_EQ(uncovered.exit_code, 0) << uncovered.err;
    EXPECT_EQ(json_of(covered)["design_white_mask"], "coverage");
    EXPECT_FALSE(json_of(covered).contains("warnings"));
    const Json shares = json_of(covered)["pixel_fractions"];
    double whole = 0.0;
    for (const char* share : {"measured", "predicted", "interpolated", "faded", "black"}) {
        whole += shares[share].get<double>();
    }
    EXPECT_NEAR(whole, 1.0, 1e-9) << shares.dump();
    EXPECT_GT(shares["measured"], 0.5) << shares.dump();
    EXPECT_NEAR(
        shares["black"].get<double>(), json_of(covered)["invalid_fraction"].get<double>(), 1e-9);
    EXPECT_NE(covered.err.find("coverage"), std::string::npos) << covered.err;
    EXPECT_EQ(json_of(uncovered)["design_white_mask"],
              "every valid pixel: the target has no coverage");
    EXPECT_GT(json_of(uncovered)["design_white_pixels"], json_of(covered)["design_white_pixels"]);
    EXPECT_NE(json_of(uncovered)["warnings"].dump().find("no coverage"), std::string::npos);
    EXPECT_NE(uncovered.err.find("warning: the target has no coverage"), std::string::npos)
        << uncovered.err;

    for (const char* command : {"render", "plan"}) {
        std::vector<std::string> words{
            command, "--json", "--calibration", calibration, "--stage", "projector"};
        words.insert(words.end(),
                     {"--camera", (folder / "camera.json").string(), "--quality", "draft"});
        if (command == std::string("render")) {
            words.insert(words.end(), {"--out", (folder / "projector.png").string()});
        }
        const ProgramRun drawn = livery_run(words);
        ASSERT_EQ(drawn.exit_code, 0) << drawn.err;
        EXPECT_EQ(json_of(drawn)["design_white_mask"], "the mock-up") << command;
        EXPECT_GT(json_of(drawn)["design_white_pixels"], 1000) << command;
        EXPECT_GT(json_of(drawn)["design_white_y"], 0.0) << command;
        EXPECT_GT(json_of(drawn)["pixel_fractions"]["measured"], 0.5) << command;
        EXPECT_NE(drawn.err.find("percentile of"), std::string::npos) << drawn.err;
    }

    for (const char* gamut : {"strict", "preserve"}) {
        const ProgramRun corrected = livery_run({"compensate",
                                                 "--json",
                                                 "--calibration",
                                                 calibration,
                                                 "--target",
                                                 wanted,
                                                 "--out",
                                                 (folder / "input.png").string(),
                                                 "--gamut",
                                                 gamut});
        ASSERT_EQ(corrected.exit_code, 0) << corrected.err;
        EXPECT_LE(json_of(corrected)["out_of_gamut_fraction"].get<double>(), 1.0);
    }
    // A wanted picture of another size is refused by name.
    const ProgramRun small = livery_run({"compensate",
                                         "--calibration",
                                         calibration,
                                         "--target",
                                         captures + "/000.exr",
                                         "--out",
                                         (folder / "x.png").string()});
    EXPECT_EQ(small.exit_code, 2);
    EXPECT_NE(small.err.find("320x200"), std::string::npos) << small.err;
}

TEST(Program, ALiveSessionIsToldWhatHappenedToIt) {
    const TemporaryFolder folder;
    const std::string spoiled = small_bench(folder);
    Json bench = Json::parse(content(spoiled));
    bench["mishaps"] = {{{"what", "camera-moved"}, {"from", 40}, {"size", 2.0}}};
    std::ofstream(spoiled) << bench.dump();
    const ProgramRun run =
        livery_run({"demo", "--json", "--bench", spoiled, "--out", (folder / "demo").string()});
    EXPECT_EQ(run.exit_code, 1);
    EXPECT_NE(run.err.find("camera, projector or mock-up moved: from gray-row-"), std::string::npos)
        << run.err;
}

TEST(Program, StopsOnInterrupt) {
    const TemporaryFolder folder;
    const pid_t child = ::fork();
    if (child == 0) {
        const std::string out = (folder / "demo").string();
        // gtest's parent keeps its own output: the child's goes nowhere.
        if (!std::freopen("/dev/null", "w", stdout) || !std::freopen("/dev/null", "w", stderr))
            _exit(3);
        ::execl(LIVERY_PROGRAM, LIVERY_PROGRAM, "demo", "--out", out.c_str(), nullptr);
        _exit(3);
    }
    ::sleep(2);
    ASSERT_EQ(::kill(child, SIGINT), 0);
    int status = 0;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    ASSERT_TRUE(WIFEXITED(status));
    EXPECT_EQ(WEXITSTATUS(status), 130);
}

TEST(Program, ASmallDemoWritesAReportThatAsksNobodyForAnything) {
    const TemporaryFolder folder;
    const std::string out = (folder / "demo folder").string();
    const ProgramRun run =
        livery_run({"demo", "--json", "--bench", small_bench(folder), "--out", out});
    ASSERT_EQ(run.exit_code, 0) << run.err;
    const Json figures = json_of(run);
    ASSERT_EQ(figures["designs"].size(), 4u);
    for (const auto& design : figures["designs"]) {
        EXPECT_LT(design["de00_median"].get<double>(),
                  0.1 * design["de00_uncompensated_median"].get<double>())
            << design.dump();
    }
    EXPECT_FALSE(figures["calibration"]["id"].get<std::string>().empty());
    EXPECT_TRUE(figures["simulated"]);
    const std::string report = content(std::filesystem::path(out) / "report.html");
    EXPECT_EQ(report.find("http:"), std::string::npos);
    EXPECT_EQ(report.find("https:"), std::string::npos);
    EXPECT_EQ(report.find("<script"), std::string::npos);
    EXPECT_NE(report.find("found from photographs, data sheets and a tape"), std::string::npos);
    // Every picture that the page names is there.
    std::size_t pictures = 0;
    for (auto at = report.find("src=\""); at != std::string::npos;
         at = report.find("src=\"", at + 1)) {
        const auto end = report.find('"', at + 5);
        const auto file = std::filesystem::path(out) / report.substr(at + 5, end - at - 5);
        EXPECT_TRUE(std::filesystem::exists(file)) << file;
        ++pictures;
    }
    EXPECT_GE(pictures, 24u);
}

}  // namespace
}  // namespace livery
