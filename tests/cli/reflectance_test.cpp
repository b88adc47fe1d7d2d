// livery brdf and livery albedo, as scripts use them.

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numbers>
#include <sstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/image_io.h"
#include "support/run_program.h"

namespace livery {
namespace {

using Json = nlohmann::ordered_json;
using Rows = std::vector<std::vector<double>>;

const std::string kHeader = "theta_i,phi_i,theta_o,phi_o\n";

class Reflectance : public ::testing::Test {
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

class Measured : public Reflectance {
  protected:
    /// Twice as bright at 700 nm as at 400 nm, the same in all directions.
    std::string spectral() const {
        std::string text = "# wavelengths\n2\n400 700\n";
        for (int k = 0; k < 12; ++k) {
            text += std::to_string(0.1 * k) + " 0 0.4 " + std::to_string(0.5 * k) + " 0.1 0.2\n";
        }
        return folder_.write("paint.brdf", text).string();
    }
    std::string colours() const {
        std::string text = "theta_i,phi_i,theta_o,phi_o,r,g,b\n";
        for (int k = 0; k < 12; ++k) {
            text +=
                std::to_string(0.1 * k) + ",0,0.4," + std::to_string(0.5 * k) + ",0.3,0.2,0.1\n";
        }
        return folder_.write("paint.csv", text).string();
    }
};

TEST_F(Measured, ReflectanceComesFromItsFile) {
    const std::string in = directions("0.3,0,0.5,2\n0.2,1,0.1,0\n1.6,0,0,0\n");
    for (const char* precision : {"f64", "f32", "gpu"}) {
        const ProgramRun run = brdf(colours(), in, {"--precision", precision});
        ASSERT_EQ(run.exit_code, 0) << run.err;
        const Json figures = Json::parse(run.out);
        EXPECT_EQ(figures["material"], "paint.csv");
        EXPECT_EQ(figures["measured"]["samples"], 12);
        EXPECT_EQ(figures["measured"].contains("resampling"), precision != std::string("f64"));
        const Rows rows = values();
        for (std::size_t k = 0; k < 3; ++k) {
            for (std::size_t c = 0; c < 3; ++c) {
                const double expected = k < 2 ? 0.3 - 0.1 * static_cast<double>(c) : 0.0;
                EXPECT_NEAR(rows[k][c], expected, 1e-6) << precision << k;
            }
        }
    }
}

TEST_F(Measured, TheShaderDrawsTheGridAsTheProcessorReadsIt) {
    std::string text = "theta_i,phi_i,theta_o,phi_o,r,g,b\n", rows;
    for (int k = 0; k < 200; ++k) {
        const double theta = 1.5 * std::fmod(0.618033988749895 * k, 1.0);
        const double other = 1.5 * std::fmod(0.754877666 * k, 1.0);
        const std::string angles = std::to_string(theta) + ",0," + std::to_string(other) + "," +
                                   std::to_string(std::fmod(0.3 * k, 6.28));
        text += angles + "," + std::to_string(0.2 + std::exp(-3.0 * theta)) + ",0.1,0.05\n";
        rows += angles + "\n" + angles.substr(0, angles.find(',')) + ",0,0.01,3\n";
    }
    const auto paint = folder_.write("varied.csv", text).string();
    const std::string in = directions(rows);
    ASSERT_EQ(brdf(paint, in, {"--precision", "f32"}).exit_code, 0);
    const Rows processor = values();
    ASSERT_EQ(brdf(paint, in, {"--precision", "gpu"}).exit_code, 0);
    const Rows shader = values();
    double lowest = 1e9, highest = 0.0;
    for (std::size_t k = 0; k < processor.size(); ++k) {
        for (std::size_t c = 0; c < 3; ++c) {
            EXPECT_NEAR(shader[k][c], processor[k][c], 1e-4 * processor[k][0]) << k;
        }
        lowest = std::min(lowest, processor[k][0]);
        highest = std::max(highest, processor[k][0]);
    }
    EXPECT_GT(highest, 2.0 * lowest);
}

TEST_F(Measured, SpectraComeOneColumnAWavelength) {
    const std::string in = directions("0.3,0,0.5,2\n1.6,0,0,0\n");
    ASSERT_EQ(brdf(spectral(), in, {"--spectral"}).exit_code, 0);
    const Rows rows = values("400,700");
    ASSERT_EQ(rows.size(), 2u);
    EXPECT_NEAR(rows[0][0], 0.1, 1e-9);
    EXPECT_NEAR(rows[0][1], 0.2, 1e-9);
    EXPECT_EQ(rows[1][1], 0.0);
    std::filesystem::remove(out());
    refuses(colours(), in, {"--spectral", "paint.csv", "no wavelengths"}, {"--spectral"});
    refuses(lambert(), in, {"--spectral", "grey", "no wavelengths"}, {"--spectral"});
    refuses(spectral(), in, {"--spectral", "f64"}, {"--spectral", "--precision", "gpu"});
    ASSERT_EQ(brdf(spectral(), in).exit_code, 0);
    EXPECT_GT(values()[0][0], values()[0][2]) << "more red than blue";
}

TEST_F(Measured, AlbedoOfADiffuserIsPiTimesItsReflectance) {
    for (const char* precision : {"f64", "f32", "gpu"}) {
        const ProgramRun run = run_program(LIVERY_PROGRAM,
                                           {"albedo",
                                            "--json",
                                            "--material",
                                            colours(),
                                            "--mu",
                                            "0.2,1",
                                            "--precision",
                                            precision});
        ASSERT_EQ(run.exit_code, 0) << run.err;
        for (const auto& albedo : Json::parse(run.out)["albedo"]) {
            EXPECT_NEAR(albedo[0].get<double>(), 0.3 * std::numbers::pi, 2e-4);
            EXPECT_NEAR(albedo[2].get<double>(), 0.1 * std::numbers::pi, 2e-4);
        }
    }
}

TEST_F(Measured, FilesAreKnownToCheckAndRefusedInOneLine) {
    const auto broken = folder_.write("broken.brdf", "3\n400 500 nan\n");
    const auto table = folder_.write("table.binary", std::string("\x5a\0\0\0\x5a\0\0\0", 8));
    const auto other = folder_.write("other.csv", "a,b\n1,2\n");
    const ProgramRun run = run_program(LIVERY_PROGRAM,
                                       {"check",
                                        "--json",
                                        spectral(),
                                        colours(),
                                        directions("0,0,0,0\n"),
                                        broken.string(),
                                        table.string(),
                                        other.string()});
    EXPECT_EQ(run.exit_code, 1);
    const Json files = Json::parse(run.out)["files"];
    const std::vector<std::string> kinds = {
        "measured", "measured", "directions", "measured", "measured", "unknown"};
    for (std::size_t k = 0; k < kinds.size(); ++k) {
        EXPECT_EQ(files[k]["kind"], kinds[k]);
        EXPECT_EQ(files[k]["ok"], k < 3) << files[k].dump();
    }
    EXPECT_EQ(files[0]["notes"][0], "12 samples");
    const std::string in = directions("0,0,0,0\n");
    refuses(broken.string(), in, {"broken.brdf", "line 2: wavelengths", "'nan'", "in nm"});
    refuses(table.string(), in, {"table.binary", "header", "8 bytes", "MERL"});
    refuses(other.string(), in, {"other.csv", "header", "'theta_i'"});
    refuses((folder_ / "none.binary").string(), in, {"none.binary", "no such file"});
}

/// The same paint as a formula and as a measurement, through the whole program.
TEST_F(Measured, APaintIsDrawnByBothBackends) {
    std::string text = "theta_i,phi_i,theta_o,phi_o,r,g,b\n";
    for (int k = 0; k < 60; ++k) {
        text += std::to_string(0.025 * k) + ",0,0.4," + std::to_string(0.5 * k) +
                ",0.15915494309,0.0795774715,0.0397887358\n";  // lambert(), measured
    }
    folder_.write("chalk.csv", text);
    folder_.write("chalk.json",
                  R"({"format_version": 1, "name": "chalk", "model": "measured",
                      "parameters": {"file": "chalk.csv"}, "provenance": "a test"})");
    lambert();
    folder_.write("camera.json",
                  R"({"width": 64, "height": 48, "matrix": [120, 0, 31.5, 0, 120, 23.5, 0, 0, 1],
                      "rotation": [1, 0, 0, 0, -1, 0, 0, 0, -1], "translation_mm": [0, 80, 400]})");
    const auto mean = [&](const std::string& paint, const std::string& backend) {
        const auto look =
            folder_.write("look.json",
                          R"({"format_version": 1, "name": "probe", "parts": {"*": ")" + paint +
                              R"("}, "lights": [{"type": "directional", "direction": [0, 1, 1],
                                   "radiance": [1, 1, 1]}]})");
        const auto picture = (folder_ / "picture.exr").string();
        const ProgramRun run = run_program(LIVERY_PROGRAM,
                                           {"render",
                                            "--json",
                                            "--product",
                                            "sphere",
                                            "--look",
                                            look.string(),
                                            "--camera",
                                            (folder_ / "camera.json").string(),
                                            "--backend",
                                            backend,
                                            "--spp",
                                            backend == "reference" ? "16" : "0",
                                            "--out",
                                            picture});
        EXPECT_EQ(run.exit_code, 0) << run.err;
        const ImageF image = read_image(picture).image;
        // R, G, B, A: the path tracer's further channels tell of its error.
        double sum = 0.0;
        for (std::size_t i = 0; i < image.pixel_count(); ++i) {
            const float* v = image.values.data() + i * static_cast<std::size_t>(image.channels);
            for (int c = 0; c < 4; ++c) sum += static_cast<double>(v[c]);
        }
        return sum / static_cast<double>(image.pixel_count());
    };
    for (const char* backend : {"gl", "reference"}) {
        const double formula = mean("grey.json", backend);
        EXPECT_GT(formula, 0.04);  // the ball fills a part of the picture, weighed by coverage
        EXPECT_NEAR(mean("chalk.json", backend), formula, 2e-3 * formula) << backend;
        EXPECT_NEAR(mean("chalk.csv", backend), formula, 2e-3 * formula) << backend;
    }
}

}  // namespace
}  // namespace livery
