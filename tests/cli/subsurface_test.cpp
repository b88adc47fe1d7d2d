// livery bssrdf and livery fit bssrdf, as scripts use them.

#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "appearance/subsurface/subsurface_profile.h"
#include "appearance/subsurface/translucent_material.h"
#include "support/run_program.h"

namespace livery {
namespace {

using Json = nlohmann::ordered_json;

ProgramRun bssrdf(const std::vector<std::string>& words) {
    std::vector<std::string> all = {"bssrdf", "--json"};
    all.insert(all.end(), words.begin(), words.end());
    return run_program(LIVERY_PROGRAM, all);
}

Json answer_of(const std::vector<std::string>& words) {
    const ProgramRun run = bssrdf(words);
    EXPECT_EQ(run.exit_code, 0) << run.err;
    return run.exit_code == 0 ? Json::parse(run.out) : Json();
}

const std::vector<std::string> kMarble = {
    "--sigma-a", "0.0041", "--sigma-s", "2.62", "--eta", "1.5", "--radii-mm", "0,0.5,2"};

std::vector<std::string> with(std::vector<std::string> words, std::vector<std::string> more) {
    words.insert(words.end(), more.begin(), more.end());
    return words;
}

TEST(Bssrdf, GivesAProfileAndTotals) {
    const Json answer = answer_of(kMarble);
    EXPECT_EQ(answer["model"], "scaled-beam-diffusion");
    EXPECT_FALSE(answer["why"].get<std::string>().empty());
    ASSERT_EQ(answer["rd"].size(), 3u);
    EXPECT_EQ(answer["radii_mm"][2], 2.0);
    EXPECT_GT(answer["rd"][0].get<double>(), 100.0 * answer["rd"][1].get<double>());
    EXPECT_FALSE(answer.contains("rt"));
    EXPECT_NEAR(answer["total_reflectance"].get<double>(), 0.76741 / 0.96, 3e-4);
    EXPECT_EQ(answer["total_transmittance"], 0.0);
    EXPECT_NEAR(answer["specular"].get<double>(), 0.04, 1e-9);
    const double sum = answer["total_reflectance"].get<double>() + answer["absorbed"].get<double>();
    EXPECT_NEAR(sum, 1.0, 1e-9);
}

TEST(Bssrdf, KnowsEveryModelOfAHalfSpaceAndOfASlab) {
    for (const SubsurfaceModelInfo& info : subsurface_models()) {
        for (const bool slab : {false, true}) {
            auto words = with(kMarble, {"--model", info.name});
            if (slab) words = with(words, {"--thickness-mm", "2"});
            const ProgramRun run = bssrdf(words);
            if (slab ? info.slab : info.half_space) {
                ASSERT_EQ(run.exit_code, 0) << info.name << run.err;
                const Json answer = Json::parse(run.out);
                EXPECT_EQ(answer["model"], info.name);
                EXPECT_EQ(answer.contains("rt"), slab);
                const double sum = answer["total_reflectance"].get<double>() +
                                   answer["total_transmittance"].get<double>() +
                                   answer["unscattered_transmittance"].get<double>() +
                                   answer["unscattered_reflectance"].get<double>() +
                                   answer["absorbed"].get<double>();
                EXPECT_NEAR(sum, 1.0, 1e-9) << info.name;
            } else {
                EXPECT_EQ(run.exit_code, 2) << info.name;
                EXPECT_NE(run.err.find(info.name), std::string::npos) << run.err;
            }
        }
    }
}

TEST(Bssrdf, CountsPhotonsTheSameForTheSameSeed) {
    const auto words =
        with(kMarble, {"--thickness-mm", "2", "--model", "montecarlo", "--photons", "6400"});
    const Json answer = answer_of(with(words, {"--seed", "3", "--threads", "1"}));
    EXPECT_EQ(answer["model"], "montecarlo");
    EXPECT_EQ(answer["seed"], 3);
    ASSERT_EQ(answer["rd_se"].size(), 3u);
    ASSERT_EQ(answer["rt_se"].size(), 3u);
    EXPECT_GT(answer["rd_se"][1].get<double>(), 0.0);
    EXPECT_NEAR(answer["total_reflectance"].get<double>(),
                0.632,
                4.0 * answer["total_reflectance_se"].get<double>());
    EXPECT_EQ(answer, answer_of(with(words, {"--seed", "3", "--threads", "2"})));
    EXPECT_NE(answer["rd"], answer_of(with(words, {"--seed", "4"}))["rd"]);
}

TEST(Bssrdf, TakesMaterialsByNameAndFile) {
    const Json named = answer_of({"--material", "skim milk", "--channel", "red"});
    EXPECT_EQ(named["medium"]["sigma_s_prime_per_mm"], 0.70);
    EXPECT_EQ(named["medium"]["sigma_a_per_mm"], 0.0014);
    EXPECT_EQ(named["medium"]["eta"], 1.3);
    EXPECT_EQ(answer_of({"--material", "marble", "--thickness-mm", "3"})["medium"]["thickness_mm"],
              3.0);
}

TEST(Bssrdf, RefusesWithTheOption) {
    const auto refuses = [](const std::vector<std::string>& words, const std::string& part) {
        const ProgramRun run = bssrdf(words);
        EXPECT_EQ(run.exit_code, 2) << part;
        EXPECT_NE(run.err.find(part), std::string::npos) << run.err;
        EXPECT_TRUE(run.out.empty());
    };
    refuses({}, "--sigma-a");
    refuses({"--sigma-a", "1"}, "--sigma-s");
    refuses({"--sigma-a", "-1", "--sigma-s", "1"}, "found -1");
    refuses({"--sigma-a", "x", "--sigma-s", "1"}, "--sigma-a");
    refuses(with(kMarble, {"--g", "1"}), "g: found 1");
    refuses(with(kMarble, {"--thickness-mm", "0"}), "thickness: found 0");
    refuses(with(kMarble, {"--model", "tripole"}), "tripole");
    refuses(with(kMarble, {"--material", "marble"}), "--material");
    refuses(with(kMarble, {"--photons", "3"}), "--photons: found 3");
    refuses(with(kMarble, {"--markdown", "a.md"}), "--markdown");
    refuses({"--material", "kryptonite"}, "kryptonite");
    refuses({"--sigma-a", "1", "--sigma-s", "1", "--radii-mm", "1,-2"}, "--radii-mm: found -2");
    refuses({"--sigma-a", "1", "--sigma-s", "1", "--eta", "0.1"}, "eta: found 0.1");
}

class BssrdfLayers : public ::testing::Test {
  protected:
    std::string stack(const std::string& layers) const {
        return folder_
            .write("stack.json", R"({"format_version": 1, "eta": 1.5, "layers": [)" + layers + "]}")
            .string();
    }
    TemporaryFolder folder_;
};

const char* const kAbove = R"({"sigma_a_per_mm": 0.17, "sigma_s_per_mm": 0.88, "thickness_mm": 1})";
const char* const kBelow =
    R"({"sigma_a_per_mm": 0.0041, "sigma_s_prime_per_mm": 2.62, "g": 0.5, "thickness_mm": 2})";

TEST_F(BssrdfLayers, HaveAProfileByEachModel) {
    const std::string file = stack(std::string(kAbove) + "," + kBelow);
    for (const std::string model : {"best", "multipole", "montecarlo"}) {
        const Json answer = answer_of(
            {"--layers", file, "--model", model, "--photons", "2000", "--radii-mm", "0.5,2"});
        EXPECT_EQ(answer["layers"].size(), 2u);
        EXPECT_NEAR(answer["layers"][1]["sigma_s_per_mm"].get<double>(), 5.24, 1e-12);
        EXPECT_EQ(answer["rd"].size(), 2u);
        EXPECT_EQ(answer["rt"].size(), 2u);
        double sum = 0.0;
        for (const char* part : {"total_reflectance",
                                 "total_transmittance",
                                 "absorbed",
                                 "unscattered_reflectance",
                                 "unscattered_transmittance"}) {
            sum += answer[part].get<double>();
        }
        // Of photons the part that scatters is a sample: .01 is the standard error of two thousand.
        EXPECT_NEAR(sum, 1.0, model == "montecarlo" ? 0.04 : 1e-9) << model;
        EXPECT_GT(answer["absorbed"].get<double>(), 0.0) << model;
    }
    const ProgramRun check = run_program(LIVERY_PROGRAM, {"check", "--json", file});
    EXPECT_EQ(check.exit_code, 0) << check.err;
    EXPECT_EQ(Json::parse(check.out)["files"][0]["kind"], "layers");
}

TEST_F(BssrdfLayers, AreRefusedWithWhatIsWrong) {
    const auto refuses = [&](const std::string& layers, const std::string& part) {
        const ProgramRun run = bssrdf({"--layers", stack(layers)});
        EXPECT_EQ(run.exit_code, 2) << layers;
        EXPECT_NE(run.err.find(part), std::string::npos) << run.err;
    };
    refuses("", "layers: found 0");
    refuses(R"({"sigma_a_per_mm": 1, "sigma_s_per_mm": 1, "thickness_mm": -1})",
            "layers[0].thickness_mm");
    refuses(std::string(R"({"sigma_a_per_mm": 1, "sigma_s_per_mm": 1},)") + kAbove, "layers[0]");
    refuses(R"({"sigma_a_per_mm": NaN, "sigma_s_per_mm": 1})", "stack.json");
    refuses(R"({"sigma_a_per_mm": 1, "sigma_s_per_mm": 1, "eta": 1.3})", "layers[0].eta");
    const std::string good = stack(kAbove);
    const ProgramRun both = bssrdf({"--layers", good, "--sigma-a", "1"});
    EXPECT_EQ(both.exit_code, 2);
    EXPECT_NE(both.err.find("--layers"), std::string::npos);
    const ProgramRun other =
        bssrdf({"--layers", stack(std::string(kAbove) + "," + kBelow), "--model", "dipole"});
    EXPECT_EQ(other.exit_code, 2);
    EXPECT_NE(other.err.find("multipole"), std::string::npos) << other.err;
    const std::string wrong =
        folder_.write("kind.json", R"({"format_version": 1, "kind": "room"})").string();
    EXPECT_EQ(bssrdf({"--layers", wrong}).exit_code, 2);
}

class FitBssrdf : public ::testing::Test {
  protected:
    /// Skim milk, green, by the best model.
    std::string profile(double farthest_mm) const {
        const auto milk = subsurface_profile(SubsurfaceModel::scaled_beam_diffusion,
                                             {0.0025, 1.22, 0.0, 1.3, {}});
        std::string text = "r_mm,rd\n";
        for (double r = 0.3; r < farthest_mm; r *= 1.15) {
            text += fmt::format("{},{}\n", r, milk.reflectance(r));
        }
        return folder_.write("milk.csv", text).string();
    }
    ProgramRun fit(const std::vector<std::string>& words) const {
        return run_program(LIVERY_PROGRAM, with({"fit", "bssrdf", "--json"}, words));
    }
    std::string out() const { return (folder_ / "milk.json").string(); }

    TemporaryFolder folder_;
};

TEST_F(FitBssrdf, WritesAMaterialThatIsReadAgain) {
    const ProgramRun run =
        fit({"--profile", profile(25.0), "--eta", "1.3", "--name", "my milk", "--out", out()});
    ASSERT_EQ(run.exit_code, 0) << run.err;
    const Json answer = Json::parse(run.out);
    EXPECT_NEAR(answer["sigma_s_prime_per_mm"].get<double>(), 1.22, 0.01);
    EXPECT_NEAR(answer["sigma_a_per_mm"].get<double>(), 0.0025, 5e-5);
    EXPECT_EQ(answer["g"], 0.0);
    EXPECT_LT(answer["error"].get<double>(), 1e-3);
    const Json& confidence = answer["confidence"];
    EXPECT_EQ(confidence["sigma_s_prime"]["verdict"], "good");
    EXPECT_EQ(confidence["g"]["verdict"], "not identifiable");
    EXPECT_GT(confidence["sigma_a"]["relative_standard_error"].get<double>(), 0.01);
    const Json again = answer_of({"--material", out()});
    EXPECT_EQ(again["medium"]["sigma_a_per_mm"], answer["sigma_a_per_mm"]);
    const ProgramRun check =
        run_program(LIVERY_PROGRAM, {"check", "--json", out(), (folder_ / "milk.csv").string()});
    EXPECT_EQ(check.exit_code, 0) << check.err;
    EXPECT_EQ(Json::parse(check.out)["files"][0]["kind"], "translucent");
    EXPECT_EQ(Json::parse(check.out)["files"][1]["kind"], "profile");
}

TEST_F(FitBssrdf, FitsTheModelsOfTheContract) {
    const std::string file = profile(25.0);
    for (const char* model : {"dipole", "p3"}) {
        const ProgramRun run = fit({"--profile", file, "--eta", "1.3", "--model", model});
        ASSERT_EQ(run.exit_code, 0) << run.err;
        EXPECT_EQ(Json::parse(run.out)["model"], model);
        EXPECT_NEAR(Json::parse(run.out)["sigma_s_prime_per_mm"].get<double>(), 1.22, 0.2);
    }
}

TEST_F(FitBssrdf, RefusesWhatIsNotTold) {
    const ProgramRun near = fit({"--profile", profile(2.0), "--eta", "1.3"});
    EXPECT_EQ(near.exit_code, 1);
    EXPECT_FALSE(Json::parse(near.out)["refused"][0]["fix"].get<std::string>().empty());
    const ProgramRun wide =
        fit({"--profile", profile(25.0), "--eta", "1.3", "--spot-mm", "1", "--out", out()});
    EXPECT_EQ(wide.exit_code, 1);
    EXPECT_NE(wide.out.find("spot"), std::string::npos);
    EXPECT_FALSE(std::filesystem::exists(out()));
}

/// From a spot of light to a medium, as the documents say it.
TEST_F(FitBssrdf, TakesWhatMeasureProfileWrites) {
    const std::string captures = (folder_ / "spot").string();
    const ProgramRun taken = run_program(
        LIVERY_PROGRAM,
        {"photograph", "--spot", "skin 1", "--size", "384x384", "--json", "--out", captures});
    ASSERT_EQ(taken.exit_code, 0) << taken.err;
    EXPECT_EQ(Json::parse(taken.out)["eta"], 1.3);
    const ProgramRun measured = run_program(LIVERY_PROGRAM,
                                            {"measure",
                                             "profile",
                                             "--json",
                                             "--captures",
                                             captures,
                                             "--eta",
                                             "1.3",
                                             "--out",
                                             (folder_ / "skin.csv").string()});
    ASSERT_EQ(measured.exit_code, 0) << measured.err;
    const Json answer = Json::parse(measured.out);
    ASSERT_EQ(answer["channels"].size(), 3u);
    const Json& green = answer["channels"][1];
    EXPECT_EQ(green["channel"], "green");
    EXPECT_NEAR(answer["view_deg"].get<double>(), 45.0, 0.2);
    EXPECT_LT(green["spot_mm"].get<double>(), green["half_energy_radius_mm"].get<double>() / 3.0);
    // The command that it says, as a shell takes it.
    const std::string command = green["fit_command"].get<std::string>();
    ASSERT_TRUE(command.starts_with("livery fit bssrdf ")) << command;
    const ProgramRun fitted = run_program(
        "/bin/sh", {"-c", std::string("'") + LIVERY_PROGRAM + "'" + command.substr(6) + " --json"});
    ASSERT_EQ(fitted.exit_code, 0) << fitted.err;
    EXPECT_NEAR(Json::parse(fitted.out)["sigma_s_prime_per_mm"].get<double>(), 0.88, 0.088);
    EXPECT_NEAR(Json::parse(fitted.out)["sigma_a_per_mm"].get<double>(), 0.17, 0.0425);
    // All three at once are a material.
    const std::string all = answer["fit_command"].get<std::string>();
    const ProgramRun three = run_program(
        "/bin/sh", {"-c", std::string("'") + LIVERY_PROGRAM + "'" + all.substr(6) + " --json"});
    ASSERT_EQ(three.exit_code, 0) << three.err;
    const Json channels = Json::parse(three.out)["channels"];
    ASSERT_EQ(channels.size(), 3u);
    EXPECT_EQ(channels[2]["channel"], "blue");
    EXPECT_EQ(channels[1]["sigma_a_per_mm"], Json::parse(fitted.out)["sigma_a_per_mm"]);
    const TranslucentMaterial skin = read_translucent_material(folder_ / "skin.json");
    EXPECT_EQ(skin.name, "skin");
    EXPECT_EQ(skin.sigma_a_per_mm.y, channels[1]["sigma_a_per_mm"].get<double>());
    EXPECT_EQ(skin.sigma_s_prime_per_mm.z, channels[2]["sigma_s_prime_per_mm"].get<double>());
    EXPECT_LT(skin.sigma_a_per_mm.x, skin.sigma_a_per_mm.y) << "skin is red";
    const ProgramRun check = run_program(
        LIVERY_PROGRAM, {"check", "--json", captures, green["file"].get<std::string>()});
    EXPECT_EQ(check.exit_code, 0) << check.err;
    EXPECT_EQ(Json::parse(check.out)["files"][0]["kind"], "spot captures");
    EXPECT_EQ(Json::parse(check.out)["files"][1]["kind"], "profile");
}

TEST_F(FitBssrdf, RefusesBadInput) {
    const std::string good = profile(25.0);
    const auto refuses = [&](const std::vector<std::string>& words, const std::string& part) {
        const ProgramRun run = fit(words);
        EXPECT_EQ(run.exit_code, 2) << part;
        EXPECT_NE(run.err.find(part), std::string::npos) << run.err;
    };
    refuses({}, "--profile");
    refuses({"--profile", "missing.csv"}, "missing.csv");
    const std::string bad = folder_.write("bad.csv", "r_mm,rd\n1,2\n2,x\n").string();
    refuses({"--profile", bad}, "line 3, rd");
    refuses({"--profile", good + "," + good}, "--profile: found 2 files");
    refuses({"--profile", good + "," + good + "," + bad}, "line 3, rd");
    refuses({"--profile", good + "," + good + "," + good, "--spot-mm", "0.1,0.1"}, "--spot-mm");
    refuses({"--profile", good, "--model", "multipole"}, "--thickness-mm is missing");
    refuses({"--profile", good, "--model", "p3", "--thickness-mm", "2"}, "--model: found p3");
    refuses({"--profile", good, "--eta", "0"}, "eta: found 0");
    refuses({"--profile", good, "--g", "2"}, "g: found 2");
    refuses({"--profile", good, "--out", "/nowhere/a.json"}, "/nowhere");
}

}  // namespace
}  // namespace livery
