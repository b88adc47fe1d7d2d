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
class EnvironmentFolderTest : public ::testing::Test {
  protected:
    EnvironmentFolderTest() {
        for (const char* name : {"0.png", "1.png", "2.png", "mask.png"}) {
            write_png(folder_ / name, Image8(4, 3, 3, 50));
        }
        folder_.write("camera.json", R"({"width": 4})");
        ball_ = Json::parse(R"({
            "format_version": 1, "environment": "ball",
            "sphere": {"centre_mm": [0, 0, 900], "diameter_mm": 60},
            "reflectance": [0.6, 0.5, 0.4], "fresnel": false,
            "black_level": 12, "exposure_s": 0.5,
            "views": [
                {"camera": "camera.json", "mask": "mask.png", "camera_deg": 4,
                 "captures": [{"file": "0.png", "exposure_s": 0.1}, {"file": "1.png"}]},
                {"camera": {"width": 8}, "sphere": {"diameter_mm": 50}, "fit_outline": false,
                 "outline_px": [[0, 1], [1, 2], [3, 4], [5, 5], [2, 9]],
                 "captures": [{"file": "2.png", "exposure_s": 2, "black_level": 3}]}]})");
        panorama_ = Json::parse(R"({
            "environment": "panorama", "mask": "mask.png", "yaw_deg": 30, "roll_deg": -2,
            "captures": [{"file": "0.png", "exposure_s": 0.1}]})");
    }
    EnvironmentFolder read(const Json& json) const {
        write_json_file(folder_ / "manifest.json", json);
        return read_environment_folder(folder_.path());
    }
    ::testing::AssertionResult fails(const Json& json,
                                     std::initializer_list<std::string_view> parts) const {
        return fails_with([&] { read(json); }, parts);
    }

    TemporaryFolder folder_;
    Json ball_, panorama_;
};

TEST_F(EnvironmentFolderTest, ABallFromTwoSides) {
    const EnvironmentFolder read = this->read(ball_);
    EXPECT_TRUE(is_environment_manifest(folder_ / "manifest.json"));
    EXPECT_EQ(read.reflectance, glm::dvec3(0.6, 0.5, 0.4));
    EXPECT_FALSE(read.fresnel);
    ASSERT_EQ(read.views.size(), 2u);
    const BallView& first = read.views[0];
    EXPECT_EQ(first.field, "views[0].");
    EXPECT_EQ(first.camera_origin, (folder_ / "camera.json").string());
    EXPECT_EQ(*first.centre_mm, glm::dvec3(0.0, 0.0, 900.0));
    EXPECT_EQ(first.diameter_mm, 60.0);
    EXPECT_TRUE(first.fit_outline);
    EXPECT_EQ(first.camera_deg, 4.0);
    EXPECT_EQ(first.mask, folder_ / "mask.png");
    ASSERT_EQ(first.captures.size(), 2u);
    EXPECT_EQ(first.captures[0].exposure_s, 0.1);
    EXPECT_EQ(first.captures[1].exposure_s, 0.5);
    EXPECT_EQ(first.captures[1].black_level, 12.0);
    const BallView& second = read.views[1];
    EXPECT_FALSE(second.centre_mm);
    EXPECT_EQ(second.diameter_mm, 50.0);
    EXPECT_FALSE(second.fit_outline);
    // From OpenCV's pixel centres at integers.
    ASSERT_EQ(second.outline_px.size(), 5u);
    EXPECT_EQ(second.outline_px[1], glm::dvec2(1.5, 2.5));
    EXPECT_EQ(second.captures[0].black_level, 3.0);
    EXPECT_EQ(photographs_of(read).size(), 3u);
}

TEST_F(EnvironmentFolderTest, OneCameraNeedsNoList) {
    Json json = ball_;
    json.erase("views");
    json.update(ball_["views"][0]);
    const EnvironmentFolder read = this->read(json);
    ASSERT_EQ(read.views.size(), 1u);
    EXPECT_EQ(read.views[0].field, "");
    EXPECT_EQ(read.views[0].captures.size(), 2u);
    EXPECT_EQ(read.views[0].captures[1].exposure_s, 0.5);
}

TEST_F(EnvironmentFolderTest, APanorama) {
    EnvironmentFolder read = this->read(panorama_);
    EXPECT_TRUE(read.views.empty());
    EXPECT_EQ(read.panorama.yaw_deg, 30.0);
    EXPECT_EQ(read.panorama.pitch_deg, 0.0);
    EXPECT_EQ(read.panorama.roll_deg, -2.0);
    EXPECT_EQ(read.panorama.mask, folder_ / "mask.png");
    EXPECT_EQ(photographs_of(read).size(), 1u);
    panorama_["marks"] = Json::parse(
        R"([{"pixel": [10, 20], "direction": [0, 0, -1]}, {"pixel": [7, 2], "direction": [3, 0, 0]}])");
    EXPECT_TRUE(fails(panorama_, {"marks: found marks and angles"}));
    panorama_.erase("yaw_deg");
    panorama_.erase("roll_deg");
    read = this->read(panorama_);
    ASSERT_TRUE(read.panorama.marks);
    EXPECT_EQ((*read.panorama.marks)[0].pixel, glm::dvec2(10.5, 20.5));
    EXPECT_EQ((*read.panorama.marks)[1].direction, glm::dvec3(3.0, 0.0, 0.0));
    panorama_["marks"][1]["direction"] = {0, 0, 0};
    EXPECT_TRUE(fails(panorama_, {"marks[1].direction: found no length"}));
    panorama_["marks"].erase(1);
    EXPECT_TRUE(fails(panorama_, {"marks: found 1 marks, expected two"}));
}

TEST_F(EnvironmentFolderTest, EachMistakeIsNamed) {
    const auto ball = [&](const std::string& pointer, const Json& value) {
        Json json = ball_;
        json[Json::json_pointer(pointer)] = value;
        return json;
    };
    EXPECT_TRUE(fails(ball("/environment", "balls"), {"environment: found", "ball or panorama"}));
    EXPECT_TRUE(fails(ball("/format_version", 7), {"newer Livery"}));
    EXPECT_TRUE(fails(ball("/sphere/diameter_mm", 0), {"sphere.diameter_mm: found 0"}));
    EXPECT_TRUE(fails(ball("/sphere/diameter_mm", -5), {"sphere.diameter_mm: found -5"}));
    EXPECT_TRUE(fails(ball("/sphere/radius_mm", 30), {"sphere", "radius_mm"}));
    EXPECT_TRUE(fails(ball("/sphere/centre_mm/1", "a"), {"sphere.centre_mm[1]"}));
    EXPECT_TRUE(fails(ball("/reflectance", 0.001), {"reflectance: found 0.001"}));
    EXPECT_TRUE(fails(ball("/reflectance", Json::array({1, 2, 0.5})), {"reflectance[1]: found 2"}));
    EXPECT_TRUE(fails(ball("/views", Json::array()), {"views: found 0 views"}));
    EXPECT_TRUE(fails(ball("/camera", "camera.json"), {"camera: found beside views"}));
    EXPECT_TRUE(fails(ball("/views/0/captures", Json::array()),
                      {"views[0].captures: found an empty list"}));
    EXPECT_TRUE(fails(ball("/views/0/captures/1/file", "no.png"),
                      {"views[0].captures[1].file", "no such file"}));
    EXPECT_TRUE(fails(ball("/views/0/captures/1/role", "white"), {"views[0].captures[1]", "role"}));
    EXPECT_TRUE(fails(ball("/views/0/captures/0/exposure_s", 0), {"exposure_s: found 0"}));
    EXPECT_TRUE(fails(ball("/views/0/mask", "no.png"), {"views[0].mask", "no such file"}));
    EXPECT_TRUE(fails(ball("/views/0/camera_deg", 120), {"views[0].camera_deg: found 120"}));
    EXPECT_TRUE(fails(ball("/views/0/camera", "no.json"), {"no.json", "no such file"}));
    EXPECT_TRUE(fails(ball("/views/1/outline_px", Json::parse("[[1, 2]]")),
                      {"views[1].outline_px: found 1 points"}));
    EXPECT_TRUE(
        fails(ball("/views/1/outline_px/2", Json::parse("[1, 2, 3]")), {"views[1].outline_px[2]"}));
    Json json = ball_;
    json["views"][1].erase("outline_px");
    EXPECT_TRUE(fails(json, {"views[1].sphere: found neither sphere.centre_mm nor outline_px"}));
    json = ball_;
    json["views"][0].erase("camera");
    EXPECT_TRUE(fails(json, {"views[0].camera"}));
    json = ball_;
    json.erase("sphere");
    EXPECT_TRUE(fails(json, {"sphere"}));
    json = panorama_;
    json["views"] = ball_["views"];
    EXPECT_TRUE(fails(json, {"views"}));
    EXPECT_TRUE(fails_with([&] { read_environment_folder(folder_ / "gone"); },
                           {"gone: found no such folder"}));
    EXPECT_TRUE(
        fails_with([&] { read_environment_folder(folder_ / "0.png"); }, {"0.png: found a file"}));
}

}  // namespace
}  // namespace livery
