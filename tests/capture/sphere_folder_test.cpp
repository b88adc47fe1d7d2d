#include <string>

#include <gtest/gtest.h>

#include "capture/stand_folders.h"
#include "core/image_io.h"
#include "core/json.h"
#include "support/file_error.h"
#include "support/temporary_folder.h"

namespace livery {
namespace {

/// A folder with pictures and a manifest that tests take apart.
class SphereFolderTest : public ::testing::Test {
  protected:
    SphereFolderTest() {
        for (const char* name : {"0.png", "1.png", "white.png"}) {
            write_png(folder_ / name, Image8(4, 3, 3, 50));
        }
        json_ = Json::parse(R"({
            "format_version": 1,
            "camera": {"width": 4, "height": 3, "matrix": [9, 0, 2, 0, 9, 1, 0, 0, 1],
                       "rotation": [1, 0, 0, 0, 1, 0, 0, 0, 1], "translation_mm": [0, 0, 0]},
            "sphere": {"centre_mm": [0, 0, 900], "diameter_mm": 60},
            "white_reference": {"file": "white.png", "reflectance": 0.9, "exposure_s": 0.5},
            "black_level": 12,
            "captures": [
                {"file": "0.png", "exposure_s": 0.1, "light_position_mm": [40, 0, 300]},
                {"file": "1.png", "exposure_s": 0.4, "light_position_mm": [40, 0, 300]}]})");
    }
    SphereFolder read() const {
        write_json_file(folder_ / "manifest.json", json_);
        return read_sphere_folder(folder_.path());
    }
    ::testing::AssertionResult fails(std::initializer_list<std::string_view> parts) const {
        return fails_with([&] { read(); }, parts);
    }

    TemporaryFolder folder_;
    Json json_;
};

TEST_F(SphereFolderTest, IsRead) {
    const SphereFolder read = this->read();
    EXPECT_EQ(read.sphere.centre_mm, glm::dvec3(0.0, 0.0, 900.0));
    EXPECT_EQ(read.sphere.diameter_mm, 60.0);
    ASSERT_EQ(read.captures.size(), 2u);
    EXPECT_EQ(read.captures[1].photograph.file, folder_ / "1.png");
    EXPECT_EQ(read.captures[1].photograph.exposure_s, 0.4);
    EXPECT_EQ(read.captures[1].photograph.black_level, 12.0);
    EXPECT_EQ(*read.captures[1].light_position_mm, glm::dvec3(40.0, 0.0, 300.0));
    ASSERT_EQ(read.white.size(), 1u);
    EXPECT_EQ(read.white[0].photograph.exposure_s, 0.5);
    EXPECT_EQ(read.white[0].photograph.black_level, 12.0);
    EXPECT_FALSE(read.white[0].light_position_mm);
    EXPECT_EQ(read.white_reflectance, glm::dvec3(0.9));
    EXPECT_FALSE(read.white_sphere);
    EXPECT_TRUE(read.camera_to_xyz.empty());
    EXPECT_EQ(Json::parse(read.camera)["width"], 4);
    EXPECT_TRUE(is_sphere_manifest(folder_ / "manifest.json"));
}

TEST_F(SphereFolderTest, TheCameraMayBeAFile) {
    folder_.write("camera.json", json_["camera"].dump());
    json_["camera"] = "camera.json";
    json_["camera_to_xyz"] = "colours.json";
    EXPECT_EQ(read().camera_origin, (folder_ / "camera.json").string());
    EXPECT_EQ(read().camera_to_xyz, folder_ / "colours.json");
    json_["camera"] = "no.json";
    EXPECT_TRUE(fails({"no.json", "no such file"}));
    json_["camera"] = 3;
    EXPECT_TRUE(fails({"camera", "3", "a camera file's fields or its name"}));
}

TEST_F(SphereFolderTest, WhiteTakesWhatItDoesNotSayFromItsCapture) {
    // The photograph of white is one of the captures, and none of the paint.
    json_["white_reference"] = {{"file", "white.png"}, {"reflectance", {0.9, 0.8, 0.7}}};
    json_["captures"].push_back(
        {{"file", "white.png"}, {"exposure_s", 0.02}, {"light_position_mm", {0, 90, 200}}});
    const SphereFolder read = this->read();
    EXPECT_EQ(read.captures.size(), 2u);
    EXPECT_EQ(read.white[0].photograph.exposure_s, 0.02);
    EXPECT_EQ(*read.white[0].light_position_mm, glm::dvec3(0.0, 90.0, 200.0));
    EXPECT_EQ(read.white_reflectance, glm::dvec3(0.9, 0.8, 0.7));
}

TEST_F(SphereFolderTest, WhiteTakesAnExposureInWhichAllAgree) {
    json_["white_reference"].erase("exposure_s");
    EXPECT_TRUE(fails({"white_reference.exposure_s", "nothing"}));
    json_["captures"][1]["exposure_s"] = 0.1;
    EXPECT_EQ(read().white[0].photograph.exposure_s, 0.1);
}

TEST_F(SphereFolderTest, WhiteMayBeSeveralPhotographsElsewhere) {
    json_["white_reference"] = Json::parse(R"({
        "reflectance": 0.95, "exposure_s": 0.25,
        "sphere": {"centre_mm": [80, 0, 900], "diameter_mm": 55},
        "captures": [{"file": "white.png", "light_position_mm": [40, 0, 300]},
                     {"file": "0.png", "exposure_s": 0.5, "light_position_mm": [90, 0, 300]}]})");
    const SphereFolder read = this->read();
    ASSERT_EQ(read.white.size(), 2u);
    EXPECT_EQ(read.white[0].photograph.exposure_s, 0.25);
    EXPECT_EQ(read.white[1].photograph.exposure_s, 0.5);
    EXPECT_EQ(read.white_sphere->diameter_mm, 55.0);
    EXPECT_EQ(read.captures.size(), 1u);
}

TEST_F(SphereFolderTest, OtherManifestsFieldsMayStandThere) {
    json_["projector"] = {1280, 800};
    json_["captures"][0]["role"] = "white";
    json_["captures"][0]["pattern"] = "0.png";
    EXPECT_NO_THROW(read());
}

TEST_F(SphereFolderTest, BadManifestsSayWhy) {
    const Json good = json_;
    const auto fails_with_change =
        [&](const char* pointer, const Json& value, std::initializer_list<std::string_view> parts) {
            json_ = good;
            json_[nlohmann::ordered_json::json_pointer(pointer)] = value;
            return fails(parts);
        };
    const auto fails_without =
        [&](const char* parent, const char* name, std::initializer_list<std::string_view> parts) {
            json_ = good;
            json_[nlohmann::ordered_json::json_pointer(parent)].erase(name);
            return fails(parts);
        };
    EXPECT_TRUE(fails_with_change("/format_version", 2, {"format_version", "newer Livery"}));
    EXPECT_TRUE(fails_with_change("/spehre", 2, {"unknown field \"spehre\""}));
    EXPECT_TRUE(fails_without("", "captures", {"captures", "nothing"}));
    EXPECT_TRUE(fails_with_change("/captures", Json::array(), {"captures", "an empty list"}));
    EXPECT_TRUE(fails_without("", "sphere", {"sphere", "nothing"}));
    EXPECT_TRUE(fails_without("", "camera", {"camera", "nothing"}));
    EXPECT_TRUE(fails_without("", "white_reference", {"white_reference", "nothing"}));
    EXPECT_TRUE(fails_with_change("/sphere/centre_mm", {1, 2}, {"sphere.centre_mm", "2 elements"}));
    EXPECT_TRUE(fails_with_change("/sphere/diameter_mm", -5, {"sphere.diameter_mm", "-5"}));
    EXPECT_TRUE(fails_with_change("/sphere/diameter_mm", "60", {"sphere.diameter_mm", "a number"}));
    EXPECT_TRUE(
        fails_without("/captures/1",
                      "light_position_mm",
                      {"captures[1].light_position_mm", "nothing", "where the light stood"}));
    EXPECT_TRUE(fails_with_change(
        "/captures/0/light_position_mm", {0, 0, 890}, {"captures[0].light_position_mm", "inside"}));
    EXPECT_TRUE(fails_with_change("/captures/0/light_position_mm",
                                  {0, 1e300, 0},
                                  {"captures[0].light_position_mm[1]", "between"}));
    EXPECT_TRUE(fails_with_change(
        "/captures/0/light_position_mm", "here", {"captures[0].light_position_mm", "\"here\""}));
    EXPECT_TRUE(fails_with_change("/captures/0/file", "no.png", {"captures[0].file", "no.png"}));
    EXPECT_TRUE(fails_without("/captures/0", "exposure_s", {"captures[0].exposure_s", "nothing"}));
    EXPECT_TRUE(fails_with_change("/captures/0/exposure_s", 0, {"captures[0].exposure_s", "0"}));
    EXPECT_TRUE(fails_with_change("/captures/0/transfer", "log", {"captures[0].transfer", "log"}));
    EXPECT_TRUE(fails_with_change("/captures/0/lamp", 1, {"unknown field \"lamp\""}));
    EXPECT_TRUE(
        fails_with_change("/white_reference/file", "no.png", {"white_reference.file", "no.png"}));
    EXPECT_TRUE(fails_without("/white_reference", "file", {"neither file nor captures"}));
    EXPECT_TRUE(fails_with_change(
        "/white_reference/captures", Json::array(), {"file and captures", "one of them"}));
    EXPECT_TRUE(fails_without(
        "/white_reference", "reflectance", {"white_reference.reflectance", "nothing"}));
    EXPECT_TRUE(fails_with_change(
        "/white_reference/reflectance", 95, {"white_reference.reflectance", "95", "between"}));
    EXPECT_TRUE(fails_with_change(
        "/white_reference/reflectance", {1, 1}, {"white_reference.reflectance", "[R, G, B]"}));
    EXPECT_TRUE(fails_with_change("/white_reference/paint", "x", {"unknown field \"paint\""}));
    json_ = good;
    json_["white_reference"]["file"] = "0.png";
    json_["captures"].erase(1);
    EXPECT_TRUE(fails({"captures", "the white reference alone"}));
}

TEST_F(SphereFolderTest, BadFilesSayWhy) {
    EXPECT_TRUE(fails_with([&] { read_sphere_folder(folder_ / "no"); }, {"no such folder"}));
    EXPECT_TRUE(fails_with([&] { read_sphere_folder(folder_ / "0.png"); }, {"0.png", "a file"}));
    EXPECT_TRUE(fails_with([&] { read_sphere_folder(folder_.path()); }, {"manifest.json"}));
    const auto parse = [&](const std::string& text) {
        parse_sphere_manifest(text, folder_ / "manifest.json");
    };
    EXPECT_TRUE(fails_with([&] { parse(""); }, {"manifest.json", "an empty file"}));
    EXPECT_TRUE(fails_with([&] { parse(json_.dump().substr(0, 90)); }, {"not JSON"}));
    EXPECT_TRUE(fails_with([&] { parse("[1]"); }, {"array"}));
    EXPECT_TRUE(fails_with([&] { parse(R"({"captures": {}})"); }, {"captures", "an array"}));
    EXPECT_TRUE(fails_with(
        [&] {
            parse(R"({"captures": [null, 3], "sphere": {"centre_mm": [0, 0, 1],
                                   "diameter_mm": 1}, "camera": {}, "white_reference":
                                   {"file": "white.png", "reflectance": 1}})");
        },
        {"captures[0]"}));
}

}  // namespace
}  // namespace livery
