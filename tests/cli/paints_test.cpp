// livery paints, as scripts use it.

#include <algorithm>
#include <cmath>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/paths.h"
#include "support/run_program.h"

namespace livery {
namespace {

using Json = nlohmann::ordered_json;

class Paints : public ::testing::Test {
  protected:
    ProgramRun run(std::vector<std::string> words) const {
        words.insert(words.begin(), {"paints", "--json"});
        return run_program(LIVERY_PROGRAM, words);
    }
    Json figures(const std::vector<std::string>& words) const {
        const ProgramRun done = run(words);
        EXPECT_EQ(done.exit_code, 0) << done.err;
        return Json::parse(done.out);
    }
    void refuses(const std::vector<std::string>& words,
                 const std::vector<std::string>& parts,
                 int exit_code = 2) const {
        const ProgramRun done = run(words);
        EXPECT_EQ(done.exit_code, exit_code) << done.err;
        for (const auto& part : parts)
            EXPECT_NE(done.err.find(part), std::string::npos) << done.err;
    }

    const TemporaryFolder folder_;
};

TEST_F(Paints, AreAllListedWithTheirFigures) {
    const Json found = figures({});
    EXPECT_GE(found["paints"].size(), 40u);
    EXPECT_GE(found["families"].size(), 9u);
    for (const Json& paint : found["paints"]) {
        EXPECT_EQ(paint["lab"].size(), 5u) << paint["name"];
        EXPECT_EQ(paint["lab"][2], paint["lab_45"]);
        EXPECT_TRUE(paint["origin"] == "measured" || paint["origin"] == "designed");
        EXPECT_TRUE(paint["gloss_60"].is_number()) << paint["name"];
        EXPECT_TRUE(paint.contains("flop_index"));
        EXPECT_TRUE(paint["shading_ns_a_pixel"].is_number() ||
                    paint.contains("shading_unknown_because"));
    }
}

TEST_F(Paints, AreFoundByWordsAndFamily) {
    const Json red = figures({"--search", "solid red"});
    ASSERT_FALSE(red["paints"].empty());
    EXPECT_EQ(red["paints"][0]["name"], "solid red");
    for (const Json& paint : figures({"--family", "rubber"})["paints"]) {
        EXPECT_EQ(paint["family"], "rubber");
    }
    EXPECT_TRUE(figures({"--search", "no such paint at all"})["paints"].empty());
    refuses({"--family", "wood"}, {"--family: found wood", "metallic", "solid"});
}

TEST_F(Paints, AreSortedByColour) {
    const std::string near_red = "lab:32,53,33";
    const Json found = figures({"--near", near_red});
    EXPECT_EQ(found["paints"][0]["name"], "solid red");
    EXPECT_LT(found["paints"][0]["de00"].get<double>(), 2.0);
    double before = 0.0;
    for (const Json& paint : found["paints"]) {
        EXPECT_GE(paint["de00"].get<double>(), before);
        before = paint["de00"].get<double>();
    }
    const std::string chips =
        folder_.write("fan.csv", "name,L,a,b\nours,32,53,33\nivory,85,1,17\n").string();
    EXPECT_EQ(figures({"--near", chips, "--chip", "OURS"})["paints"][0], found["paints"][0]);
    EXPECT_EQ(figures({"--near", chips, "--chip", "ivory"})["paints"][0]["name"], "solid ivory");
    const Json one = figures({"solid red", "--near", near_red});
    EXPECT_EQ(one["paints"][0]["de00"], found["paints"][0]["de00"]);
    refuses({"--near", "crimsonish"}, {"colour 'crimsonish'", "#RRGGBB"});
    refuses({"--near", chips}, {"which chip", "--chip"});
    refuses({"--near", chips, "--chip", "green"}, {"no chip named 'green'", "'ours', 'ivory'"});
    refuses({"--near", near_red, "--chip", "x"}, {"--chip is for --near FILE.csv"});
    refuses({"--near", (folder_ / "none.csv").string(), "--chip", "x"}, {"none.csv"});
    const std::string bad = folder_.write("bad.csv", "name,L,a,b\nx,1,2,red\n").string();
    refuses({"--near", bad, "--chip", "x"}, {"bad.csv", "line 2", "'red'"});
}

TEST_F(Paints, AreToldOneByOne) {
    const Json silver = figures({"silver-metallic"})["paints"][0];
    EXPECT_EQ(silver["name"], "silver metallic");
    EXPECT_GT(silver["flop_index"].get<double>(), 8.0);
    const std::string file = folder_
                                 .write("grey.json",
                                        R"({"format_version": 1, "name": "grey", "model": "lambert",
                                           "parameters": {"diffuse": [0.5, 0.5, 0.5]}})")
                                 .string();
    const Json grey = figures({file})["paints"][0];
    EXPECT_EQ(grey["flop_index"], 0.0);
    EXPECT_NEAR(grey["lab_45"][0].get<double>(), 76.069, 0.001);
    const ProgramRun text = run_program(LIVERY_PROGRAM, {"paints", file});
    EXPECT_EQ(text.exit_code, 0);
    for (const char* part : {"grey (no family), model lambert",
                             "origin not told",
                             "  110 degrees",
                             "flop index: 0.00",
                             "gloss at 20 degrees: "}) {
        EXPECT_NE(text.out.find(part), std::string::npos) << part << " in " << text.out;
    }
    const ProgramRun gold = run_program(LIVERY_PROGRAM, {"paints", "gold metallic"});
    EXPECT_NE(gold.out.find("glints: 1000 flakes on a square millimetre, physical\n"),
              std::string::npos)
        << gold.out;
    EXPECT_EQ(text.out.find("glints"), std::string::npos);
    refuses({"solid rad"}, {"no paint named 'solid rad'", "'solid red'"});
    refuses({"solid red", "--search", "x"}, {"NAME is one paint"});
}

TEST_F(Paints, AreMadeInAColour) {
    const std::string out = (folder_ / "our-blue.json").string();
    const Json made =
        figures({"silver metallic", "--tint", "lab:30,5,-30", "--out", out})["paints"][0];
    EXPECT_LT(made["de00"].get<double>(), 0.5);
    EXPECT_EQ(made["name"], "our-blue");
    const Json again = figures({out})["paints"][0];
    EXPECT_NEAR(again["lab_45"][0].get<double>(), 30.0, 0.3);
    EXPECT_NEAR(again["lab_45"][2].get<double>(), -30.0, 0.5);
    const std::string other = (folder_ / "other.json").string();
    refuses({"chrome trim", "--tint", "lab:60,0,0", "--out", other}, {"too light", "refused"}, 1);
    EXPECT_FALSE(std::filesystem::exists(other));
    refuses({"solid red", "--tint", "#304050"}, {"--tint and --out need each other"});
    refuses({"--tint", "#304050", "--out", other}, {"--tint needs NAME"});
    refuses({"solid red", "--tint", "#304050", "--out", other, "--near", "#304050"},
            {"--near and --tint"});
}

TEST_F(Paints, PrintTheTableOfTheDocuments) {
    const auto page = folder_.write(
        "page.md", "# P\n<!-- paints: begin -->\nbefore\n<!-- paints: end -->\nrest\n");
    figures({"--markdown", page.string()});
    const std::string text = read_text_file(page);
    EXPECT_NE(text.find("| solid red | solid | designed | `clearcoat` |"), std::string::npos);
    EXPECT_EQ(text.find("before"), std::string::npos);
    EXPECT_TRUE(text.ends_with("|\n<!-- paints: end -->\nrest\n"));
    refuses({"--markdown", folder_.write("plain.md", "# P\n").string()}, {"paints: begin"});
    refuses({"--markdown", page.string(), "--family", "solid"}, {"the whole library"});
}

TEST_F(Paints, HaveTheTableOfTheDocumentsAsItIsNow) {
    const std::string docs = read_text_file(LIVERY_SOURCE "/docs/materials.md");
    const auto copy = folder_.write("materials.md", docs);
    figures({"--markdown", copy.string()});
    EXPECT_EQ(read_text_file(copy), docs)
        << "livery paints --markdown docs/materials.md prints it anew";
}

}  // namespace
}  // namespace livery
