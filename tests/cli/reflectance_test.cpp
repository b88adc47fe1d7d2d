// livery brdf and livery albedo, as scripts use them.

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numbers>
#include <sstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "support/run_program.h"

namespace livery {
namespace {

using Json = nlohmann::ordered_json;
using Rows = std::vector<std::vector<double>>;

const std::string kHeader = "theta_i,phi_i,theta_o,phi_o\n";

class Reflectance : public testing::Test {
  protected:
    std::string lambert() const {
        return folder_
            .write("grey.json",
                   R"({"format_version": 1, "name": "grey", "model": "lambert",
                       "parameters": {"diffuse": [0.5, 0.25, 0.125]}})")
            .string();
    }
    std::string directions(const std::string& rows) const {
        return folder_.write("dirs.csv", kHeader + rows).string();
    }
    std::string out() const { return (folder_ / "values.csv").string(); }

    ProgramRun brdf(const std::string& material,
                    const std::string& in,
                    const std::vector<std::string>& more = {}) const {
        std::vector<std::string> words = {
            "brdf", "--json", "--material", material, "--in", in, "--out", out()};
        words.insert(words.end(), more.begin(), more.end());
        return run_program(LIVERY_PROGRAM, words);
    }

    /// The rows of the output; its header must be this.
    Rows values(const std::string& header = "r,g,b") const {
        std::ifstream file(out());
        std::string line;
        std::getline(file, line);
        EXPECT_EQ(line, header);
        Rows rows;
        while (std::getline(file, line)) {
            rows.emplace_back();
            std::istringstream cells(line);
            for (std::string cell; std::getline(cells, cell, ',');) {
                rows.back().push_back(std::stod(cell));
            }
        }
        return rows;
    }

    void refuses(const std::string& material,
                 const std::string& in,
                 const std::vector<std::string>& parts,
                 const std::vector<std::string>& more = {}) const {
        const ProgramRun run = brdf(material, in, more);
        EXPECT_EQ(run.exit_code, 2) << run.err;
        EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
        EXPECT_TRUE(run.out.empty()) << run.out;
        EXPECT_FALSE(std::filesystem::exists(out()));
        for (const auto& part : parts) EXPECT_NE(run.err.find(part), std::string::npos) << run.err;
    }

    const TemporaryFolder folder_;
};

TEST_F(Reflectance, OfADiffuserIsTheSameEverywhereAboveTheHorizon) {
    const std::string in = directions(
        "0,0,0,0\n0.7,1,1.5,4\n1.5707,0,1.5707,3\n1.5709,0,0.1,0\n0.1,0,1.5709,0\n3.2,0,0.1,0\n"
        "6.3,0,0.1,0\n");
    for (const char* precision : {"f32", "f64", "gpu"}) {
        const ProgramRun run = brdf(lambert(), in, {"--precision", precision});
        ASSERT_EQ(run.exit_code, 0) << run.err;
        const Json figures = Json::parse(run.out);
        EXPECT_EQ(figures["count"], 7);
        EXPECT_EQ(figures["invalid"], 0);
        const Rows rows = values();
        ASSERT_EQ(rows.size(), 7u);
        for (std::size_t k = 0; k < rows.size(); ++k) {
            const double share = k < 3 ? 1.0 / std::numbers::pi : 0.0;
            EXPECT_NEAR(rows[k][0], 0.5 * share, 2e-7) << precision << k;
            EXPECT_NEAR(rows[k][1], 0.25 * share, 2e-7) << precision << k;
            EXPECT_NEAR(rows[k][2], 0.125 * share, 2e-7) << precision << k;
        }
    }
}

TEST_F(Reflectance, OfEveryPrecisionAgreesAndIsReciprocal) {
    std::string rows, exchanged;
    for (int k = 0; k < 3000; ++k) {  // half of them near the mirror direction
        const double theta = 1.5 * std::fmod(0.618033988749895 * k, 1.0);
        const double other = k % 2 ? 1.5 * std::fmod(0.754877666 * k, 1.0) : theta + 1e-3;
        const double phi = k % 2 ? 0.01 * k : std::numbers::pi;
        const auto text = [](double a, double b) {
            return std::to_string(a) + "," + std::to_string(b);
        };
        rows += text(theta, 0.3) + "," + text(other, 0.3 + phi) + "\n";
        exchanged += text(other, 0.3 + phi) + "," + text(theta, 0.3) + "\n";
    }
    const std::string in = directions(rows);
    const auto evaluate = [&](const std::string& file, std::vector<std::string> more) {
        EXPECT_EQ(brdf("blue metallic", file, more).exit_code, 0);
        return values();
    };
    const Rows truth = evaluate(in, {"--round-inputs"});
    ASSERT_EQ(truth.size(), 3000u);
    const Rows swapped = evaluate(directions(exchanged), {"--round-inputs"});
    const Rows in_float = evaluate(directions(rows), {"--precision", "f32"});
    const Rows on_gpu = evaluate(in, {"--precision", "gpu"});
    bool differs = false;
    for (std::size_t k = 0; k < truth.size(); ++k) {
        const double scale = *std::max_element(truth[k].begin(), truth[k].end());
        for (std::size_t c = 0; c < 3; ++c) {
            EXPECT_NEAR(swapped[k][c], truth[k][c], 1e-5 * scale) << k;
            EXPECT_NEAR(in_float[k][c], truth[k][c], 1e-4 * scale + 1e-6) << k;
            EXPECT_NEAR(on_gpu[k][c], truth[k][c], 1e-4 * scale + 1e-6) << k;
            differs = differs || in_float[k][c] != truth[k][c];
        }
    }
    EXPECT_TRUE(differs) << "float rounds";
}

TEST_F(Reflectance, ColumnsMayStandInAnyOrderAmongOthers) {
    const auto in =
        folder_.write("dirs.csv", "name,phi_o,theta_o,theta_i,phi_i\na,0,1.6,0,0\nb,1,0.2,0.3,0\n");
    ASSERT_EQ(brdf(lambert(), in.string()).exit_code, 0);
    const Rows rows = values();
    ASSERT_EQ(rows.size(), 2u);
    EXPECT_EQ(rows[0][0], 0.0);
    EXPECT_NEAR(rows[1][0], 0.5 / std::numbers::pi, 1e-12);
}

TEST_F(Reflectance, RefusesBadDirectionsWithTheirLine) {
    const std::string paint = lambert();
    const auto write = [&](const std::string& text) {
        return folder_.write("bad.csv", text).string();
    };
    refuses(paint, (folder_ / "none.csv").string(), {"none.csv", "no such file"});
    refuses(paint, folder_.path().string(), {"a folder", "a file"});
    refuses(paint, write(""), {"bad.csv", "nothing", "a header"});
    refuses(paint, write(kHeader), {"bad.csv", "no rows"});
    refuses(
        paint, write("theta_i,phi_i,theta_o\n0,0,0\n"), {"header", "'phi_o'", "theta_i, phi_i"});
    refuses(paint, write("0,0,0,0\n0,0,0,0\n"), {"line 1, column 2", "second time"});
    refuses(paint, write(kHeader + "0,0,0,0\n0,0,nan,0\n"), {"line 3, theta_o", "'nan'", "finite"});
    refuses(paint, write(kHeader + "0,0,inf,0\n"), {"line 2, theta_o", "'inf'", "finite"});
    refuses(paint, write(kHeader + "-0.1,0,0,0\n"), {"line 2, theta_i", "'-0.1'", "0 or more"});
    refuses(paint, write(kHeader + "0,0,0,0\n0.5,0,0."), {"line 3", "3 cells", "as in the header"});
    refuses(paint, write(kHeader + "0,0,0,1e999\n"), {"line 2, phi_o", "1e999", "finite"});
    refuses(paint, write(kHeader + std::string("0,0,\0\1\xff,0\n", 11)), {"line 2, theta_o"});
}

TEST_F(Reflectance, RefusesBadPaintsAndPlaces) {
    const std::string in = directions("0,0,0,0\n");
    refuses("no such paint", in, {"no such paint"});
    refuses(folder_
                .write("nan.json",
                       R"({"format_version": 1, "name": "n", "model": "ggx",
                              "parameters": {"diffuse": [0,0,0], "f0": [0,0,0], "alpha": 1e-9}})")
                .string(),
            in,
            {"nan.json", "parameters.alpha"});
    refuses(lambert(), in, {"--precision", "f16", "f32, f64, gpu"}, {"--precision", "f16"});
    const ProgramRun full = run_program(
        LIVERY_PROGRAM, {"brdf", "--material", lambert(), "--in", in, "--out", "/dev/full"});
    EXPECT_EQ(full.exit_code, 2);
    EXPECT_NE(full.err.find("/dev/full"), std::string::npos) << full.err;
}

TEST_F(Reflectance, AlbedoOfADiffuserIsItsColour) {
    for (const char* precision : {"f32", "f64", "gpu"}) {
        const ProgramRun run = run_program(LIVERY_PROGRAM,
                                           {"albedo",
                                            "--json",
                                            "--material",
                                            lambert(),
                                            "--mu",
                                            "0.01,0.3,1",
                                            "--precision",
                                            precision});
        ASSERT_EQ(run.exit_code, 0) << run.err;
        const Json figures = Json::parse(run.out);
        EXPECT_EQ(figures["mu"], (std::vector<double>{0.01, 0.3, 1.0}));
        ASSERT_EQ(figures["albedo"].size(), 3u);
        for (const auto& albedo : figures["albedo"]) {
            EXPECT_NEAR(albedo[0].get<double>(), 0.5, 1e-6);
            EXPECT_NEAR(albedo[1].get<double>(), 0.25, 1e-6);
            EXPECT_NEAR(albedo[2].get<double>(), 0.125, 1e-6);
        }
    }
}

TEST_F(Reflectance, AlbedoOfRoughWhiteMetalIsWhatMaskingLeaves) {
    const auto metal = folder_.write("metal.json",
                                     R"({"format_version": 1, "name": "m", "model": "ggx",
            "parameters": {"diffuse": [0, 0, 0], "f0": [1, 1, 1], "alpha": 1}})");
    for (const char* precision : {"f32", "f64", "gpu"}) {
        const ProgramRun run = run_program(LIVERY_PROGRAM,
                                           {"albedo",
                                            "--json",
                                            "--material",
                                            metal.string(),
                                            "--mu",
                                            "1",
                                            "--precision",
                                            precision});
        ASSERT_EQ(run.exit_code, 0) << run.err;
        const Json figures = Json::parse(run.out);
        EXPECT_NEAR(figures["albedo"][0][1].get<double>(), 1.0 - std::numbers::ln2, 2e-5);
        EXPECT_NEAR(figures["largest_working"].get<double>(), 1.0 - std::numbers::ln2, 2e-5);
    }
}

TEST_F(Reflectance, AlbedoRefusesWhatIsNoCosine) {
    for (const char* mu : {"0", "1.5", "-0.2", "nan", "x", "0.5,", ""}) {
        const ProgramRun run =
            run_program(LIVERY_PROGRAM, {"albedo", "--material", lambert(), "--mu", mu});
        EXPECT_EQ(run.exit_code, 2) << mu;
        EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
        EXPECT_NE(run.err.find("--mu"), std::string::npos) << run.err;
    }
}

}  // namespace
}  // namespace livery
