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
class SpotFolderTest : public ::testing::Test {
  protected:
    SpotFolderTest() {
        for (const char* name : {"0.png", "1.png", "dark.png", "white.png"}) {
            write_png(folder_ / name, Image8(4, 3, 3, 50));
        }
        json_ = Json::parse(R"({
            "format_version": 1,
            "camera": {"width": 4, "height": 3, "matrix": [9, 0, 2, 0, 9, 1, 0, 0, 1],
                       "rotation": [1, 0, 0, 0, 1, 0, 0, 0, 1], "translation_mm": [0, 0, 0]},
            "plane": {"point_mm": [0, 0, 600], "normal": [0, 0, -3]},
            "projector_mm": [400, 0, 0],
            "black_level": 12,
            "captures": [{"file": "0.png", "exposure_s": 0.1}, {"file": "1.png", "exposure_s": 0.8}],
            "black": [{"file": "dark.png", "exposure_s": 0.8}],
            "white_reference": {"reflectance": [0.9, 0.8, 0.7], "exposure_s": 0.05,
                                "captures": [{"file": "white.png"}],
                                "black": [{"file": "dark.png", "black_level": 3}]}})");
    }
    SpotFolder read() const {
        write_json_file(folder_ / "manifest.json", json_);
        return read_spot_folder(folder_.path());
    }
    ::testing::AssertionResult fails(std::initializer_list<std::string_view> parts) const {
        return fails_with([&] { read(); }, parts);
    }

    TemporaryFolder folder_;
    Json json_;
};

TEST_F(SpotFolderTest, IsRead) {
    const SpotFolder read = this->read();
    ASSERT_TRUE(read.places);
    EXPECT_FALSE(read.scale);
    EXPECT_EQ(read.places->point_mm, glm::dvec3(0.0, 0.0, 600.0));
    EXPECT_EQ(read.places->normal, glm::dvec3(0.0, 0.0, -1.0));
    EXPECT_EQ(read.places->projector_mm, glm::dvec3(400.0, 0.0, 0.0));
    EXPECT_EQ(Json::parse(read.places->camera)["width"], 4);
    ASSERT_EQ(read.sample.lit.size(), 2u);
    EXPECT_EQ(read.sample.lit[1].file, folder_ / "1.png");
    EXPECT_EQ(read.sample.lit[1].exposure_s, 0.8);
    EXPECT_EQ(read.sample.lit[1].black_level, 12.0);
    ASSERT_EQ(read.sample.black.size(), 1u);
    ASSERT_EQ(read.white.lit.size(), 1u);
    EXPECT_EQ(read.white.lit[0].exposure_s, 0.05);
    EXPECT_EQ(read.white.lit[0].black_level, 12.0);
    EXPECT_EQ(read.white.black[0].black_level, 3.0);
    EXPECT_EQ(read.white_reflectance, glm::dvec3(0.9, 0.8, 0.7));
    EXPECT_EQ(photographs_of(read).size(), 5u);
    EXPECT_TRUE(is_spot_manifest(folder_ / "manifest.json"));
}

TEST_F(SpotFolderTest, ACameraAlongTheNormalNeedsItsScaleAlone) {
    for (const char* name : {"camera", "plane", "projector_mm"}) json_.erase(name);
    json_["mm_per_px"] = 0.04;
    json_["incidence_deg"] = 12;
    const SpotFolder read = this->read();
    EXPECT_FALSE(read.places);
    EXPECT_EQ(read.scale->mm_per_px, 0.04);
    EXPECT_EQ(read.scale->incidence_deg, 12.0);
    json_["projector_mm"] = {1, 2, 3};
    EXPECT_TRUE(fails({"projector_mm", "beside mm_per_px"}));
}

TEST_F(SpotFolderTest, BadManifestsSayWhy) {
    const Json good = json_;
    const auto fails_with_change =
        [&](const char* pointer, const Json& value, std::initializer_list<std::string_view> parts) {
            json_ = good;
            json_[Json::json_pointer(pointer)] = value;
            return fails(parts);
        };
    const auto fails_without = [&](const char* name,
                                   std::initializer_list<std::string_view> parts) {
        json_ = good;
        json_.erase(name);
        return fails(parts);
    };
    for (const char* name : {"plane", "projector_mm", "captures", "black", "white_reference"}) {
        EXPECT_TRUE(fails_without(name, {name, "nothing"})) << name;
    }
    EXPECT_TRUE(fails_without("camera", {"neither camera nor mm_per_px"}));
    EXPECT_TRUE(fails_with_change("/mm_per_px", 0.1, {"camera and mm_per_px"}));
    EXPECT_TRUE(fails_with_change("/incidence_deg", 3, {"incidence_deg", "beside a camera"}));
    EXPECT_TRUE(fails_with_change("/plane/normal", {0, 0, 0}, {"plane.normal", "no length"}));
    EXPECT_TRUE(fails_with_change("/plane/point_mm", {0, 0, 1e9}, {"plane.point_mm[2]", "1e"}));
    EXPECT_TRUE(fails_with_change("/plane/tilt", 1, {"tilt"}));
    EXPECT_TRUE(fails_with_change("/sphere", Json::object(), {"sphere"}));
    EXPECT_TRUE(fails_with_change("/format_version", 2, {"format_version", "2"}));
    EXPECT_TRUE(fails_with_change("/captures", Json::array(), {"captures", "an empty list"}));
    EXPECT_TRUE(fails_with_change("/captures/0/file", "no.png", {"captures[0].file", "no.png"}));
    EXPECT_TRUE(fails_with_change("/captures/0/exposure_s", 0, {"captures[0].exposure_s", "0"}));
    EXPECT_TRUE(fails_with_change("/captures/0/exposure_s", nullptr, {"exposure_s", "seconds"}));
    EXPECT_TRUE(fails_with_change("/captures/0/role", "white", {"role"}));
    EXPECT_TRUE(fails_with_change("/white_reference/black", Json::array(), {"black", "an empty"}));
    EXPECT_TRUE(fails_with_change("/white_reference/reflectance", 0.01, {"reflectance", "0.01"}));
    EXPECT_TRUE(fails_with_change("/white_reference/reflectance", 1.2, {"reflectance", "1.2"}));
    EXPECT_TRUE(fails_with_change("/camera", 3, {"camera", "3"}));
    json_ = good;
    json_["captures"] = Json(std::vector<Json>(1001, good["captures"][0]));
    EXPECT_TRUE(fails({"captures", "1001 captures", "at most 1000"}));
    folder_.write("manifest.json", R"({"captures": [)");
    EXPECT_TRUE(fails_with([&] { read_spot_folder(folder_.path()); }, {"manifest.json"}));
    EXPECT_TRUE(fails_with([&] { read_spot_folder(folder_ / "0.png"); }, {"a file"}));
}

}  // namespace
}  // namespace livery
