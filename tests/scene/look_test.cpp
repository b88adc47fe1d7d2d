#include "scene/look.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/json.h"
#include "scene/broken.h"
#include "support/file_error.h"
#include "support/temporary_folder.h"

namespace livery {
namespace {

Json evening_look() {
    return Json::parse(R"({"format_version": 1, "name": "evening",
        "parts": {"body": "red", "*": "grey"},
        "lights": [{"type": "directional", "direction": [0, 3, 4], "radiance": [1, 0.9, 0.8],
                    "angle_rad": 0.01}],
        "environment": {"file": "sky.hdr", "rotation_rad": 1.5, "scale": 0.25},
        "exposure_ev": -1})");
}

TEST(LookFile, IsReadWithLightsNormalised) {
    const TemporaryFolder folder;
    const Look look = read_look_file(folder.write("look.json", evening_look().dump()));
    EXPECT_EQ(look.name, "evening");
    EXPECT_EQ(look.parts.at("body"), "red");
    EXPECT_EQ(look.parts.at("*"), "grey");
    ASSERT_EQ(look.lights.size(), 1u);
    EXPECT_LT(glm::distance(look.lights[0].direction, glm::dvec3(0, 0.6, 0.8)), 1e-15);
    EXPECT_EQ(look.lights[0].radiance_rec709, glm::dvec3(1, 0.9, 0.8));
    EXPECT_EQ(look.environment.scale, 0.25);
    EXPECT_EQ(look.exposure_ev, -1.0);
}

TEST(LookFile, ComesBackAsItWas) {
    const TemporaryFolder folder;
    const Look look = read_look_file(folder.write("look.json", evening_look().dump()));
    write_look_file(folder / "again.json", look);
    const Look again = read_look_file(folder / "again.json");
    EXPECT_EQ(again.name, look.name);
    EXPECT_EQ(again.parts, look.parts);
    EXPECT_LT(glm::distance(again.lights.at(0).direction, look.lights.at(0).direction), 1e-15);
    EXPECT_EQ(again.lights[0].angle_rad, look.lights[0].angle_rad);
    EXPECT_EQ(again.environment.file, look.environment.file);
    EXPECT_EQ(again.environment.rotation_rad, look.environment.rotation_rad);
    EXPECT_EQ(again.exposure_ev, look.exposure_ev);
}

TEST(LookFile, NeedsNothingButItsVersion) {
    const TemporaryFolder folder;
    const Look look = read_look_file(folder.write("plain.json", R"({"format_version": 1})"));
    EXPECT_EQ(look.name, "plain");
    EXPECT_TRUE(look.parts.empty() && look.lights.empty() && look.environment.file.empty());
}

const Broken kBrokenLooks[] = {
    {"no version", [](Json& l) { l.erase("format_version"); }, "format_version: found nothing"},
    {"newer version", [](Json& l) { l["format_version"] = 2; }, "found 2 (written by a newer"},
    {"misspelt field", [](Json& l) { l["light"] = 1; }, "the unknown field \"light\""},
    {"parts as a list", [](Json& l) { l["parts"] = {1}; }, "parts: found [1], expected an object"},
    {"paint of no name", [](Json& l) { l["parts"]["body"] = ""; }, "parts.body: found an empty"},
    {"paint as a number", [](Json& l) { l["parts"]["body"] = 3; }, "parts.body: found 3"},
    {"lights as an object", [](Json& l) { l["lights"] = Json::object(); }, "lights: found {}"},
    {"unknown light",
     [](Json& l) { l["lights"][0]["type"] = "point"; },
     "lights[0].type: found \"point\", expected \"directional\""},
    {"no direction",
     [](Json& l) { l["lights"][0].erase("direction"); },
     "lights[0].direction: found"},
    {"endless direction",
     [](Json& l) {
         l["lights"][0]["direction"] = {1e155, 0, 0};
     },
     "lights[0].direction[0]: found 1e+155, expected a number between -1e+06 and 1e+06"},
    {"direction of no length",
     [](Json& l) {
         l["lights"][0]["direction"] = {0, 0, 0};
     },
     "lights[0].direction: found a vector of no length"},
    {"two colours",
     [](Json& l) {
         l["lights"][0]["radiance"] = {1, 1};
     },
     "lights[0].radiance: found"},
    {"radiance that is no number",
     [](Json& l) { l["lights"][0]["radiance"][1] = nullptr; },
     "lights[0].radiance[1]: found null"},
    {"light wider than the sky",
     [](Json& l) { l["lights"][0]["angle_rad"] = 4; },
     "lights[0].angle_rad: found 4"},
    {"degrees where radians are meant",
     [](Json& l) { l["lights"][0]["angle_deg"] = 4; },
     "lights[0]: found the unknown field \"angle_deg\""},
    {"no map", [](Json& l) { l["environment"].erase("file"); }, "environment.file: found nothing"},
    {"negative sky",
     [](Json& l) { l["environment"]["scale"] = -1; },
     "environment.scale: found -1"},
    {"exposure", [](Json& l) { l["exposure_ev"] = 1000; }, "exposure_ev: found 1000"},
};

TEST(LookFile, EachMistakeIsNamed) {
    const TemporaryFolder folder;
    for (const auto& broken : kBrokenLooks) {
        Json json = evening_look();
        broken.damage(json);
        const auto file = folder.write("look.json", json.dump());
        EXPECT_TRUE(fails_with([&] { read_look_file(file); }, {"look.json", broken.message}))
            << broken.what;
    }
    const std::string good = evening_look().dump();
    EXPECT_TRUE(fails_with([&] { read_look_file(folder / "gone.json"); }, {"no such file"}));
    EXPECT_TRUE(fails_with([&] { read_look_file(folder.write("a.json", "")); }, {"empty file"}));
    EXPECT_TRUE(fails_with([&] { read_look_file(folder.write("a.json", good.substr(0, 90))); },
                           {"text that is not JSON"}));
    EXPECT_TRUE(
        fails_with([&] { read_look_file(folder.write("a.json", "[]")); }, {"a JSON object"}));
}

}  // namespace
}  // namespace livery
