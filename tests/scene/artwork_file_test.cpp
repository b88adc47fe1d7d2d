// Artwork in look files.
#include <functional>

#include <gtest/gtest.h>

#include "core/json.h"
#include "scene/look.h"
#include "support/file_error.h"
#include "support/temporary_folder.h"

namespace livery {
namespace {

Json liveried_look() {
    return Json::parse(R"({"format_version": 1, "name": "liveried", "parts": {"*": "grey"},
        "artwork": [
          {"name": "two tones", "part": "body", "paint": "white", "shape": "half",
           "softness_mm": 2, "place": {"centre_mm": [0, 30, 0], "up": [0, 1, 0.5]}},
          {"paint": "red", "shape": "stripes", "size_mm": 14, "share": 0.25},
          {"paint": "red", "shape": "checks", "size_mm": 3},
          {"paint": "red", "shape": "dots", "size_mm": 3, "share": 0.75},
          {"part": "body", "shape": "picture", "picture": "number.png", "use": "colours",
           "size_mm": 40, "place": {"centre_mm": [10, 30, 40], "direction": [0, 0, -1]}},
          {"part": "body", "shape": "picture", "picture": "grain.png", "use": "roughness",
           "repeat": true, "place": "uv"},
          {"part": "body", "shape": "picture", "picture": "waves.png", "use": "relief",
           "repeat": true, "depth": -0.5, "size_mm": 30}]})");
}

Look look_of(const Json& json) { return parse_look(json.dump(), "look.json"); }

TEST(ArtworkFile, IsRead) {
    const Look look = look_of(liveried_look());
    ASSERT_EQ(look.artwork.size(), 7u);
    const Artwork& tones = look.artwork[0];
    EXPECT_EQ(tones.name, "two tones");
    EXPECT_EQ(tones.part, "body");
    EXPECT_EQ(tones.paint, "white");
    EXPECT_EQ(tones.shape, ArtworkShape::half);
    EXPECT_EQ(tones.softness_mm, 2.0);
    EXPECT_EQ(tones.place.centre_mm, glm::dvec3(0, 30, 0));
    EXPECT_TRUE(tones.place.through);
    EXPECT_EQ(look.artwork[1].part, "*");
    EXPECT_EQ(look.artwork[1].share, 0.25);
    const Artwork& number = look.artwork[4];
    EXPECT_EQ(number.use, PictureUse::colours);
    EXPECT_EQ(number.paint, "");
    EXPECT_FALSE(number.place.through) << "a decal does not show on the other side";
    EXPECT_FALSE(number.repeat);
    EXPECT_TRUE(look.artwork[5].place.by_uv);
    EXPECT_TRUE(look.artwork[5].repeat);
    EXPECT_EQ(look.artwork[6].use, PictureUse::relief);
    EXPECT_EQ(look.artwork[6].depth, -0.5);
}

TEST(ArtworkFile, ComesBackAsItWas) {
    const TemporaryFolder folder;
    const Look look = look_of(liveried_look());
    write_look_file(folder / "again.json", look);
    EXPECT_EQ(read_look_file(folder / "again.json").artwork, look.artwork);
}

TEST(ArtworkFile, EveryMistakeIsNamed) {
    struct Case {
        std::function<void(Json&)> change;  ///< of the list
        const char* field;
        const char* part_of_message;
    };
    const std::vector<Case> cases = {
        {[](Json& a) { a[0]["shape"] = "zigzag"; }, "artwork[0].shape", "half, stripes"},
        {[](Json& a) { a[0].erase("shape"); }, "artwork[0].shape", ""},
        {[](Json& a) { a[0]["colour"] = 1; }, "artwork[0].colour", "softness_mm"},
        {[](Json& a) { a[1]["picture"] = "x.png"; }, "artwork[1].picture", "size_mm"},
        {[](Json& a) { a[1]["size_mm"] = 0; }, "artwork[1]", "size_mm is 0"},
        {[](Json& a) { a[1]["size_mm"] = -3; }, "artwork[1]", "size_mm is -3"},
        {[](Json& a) { a[1]["share"] = 1.5; }, "artwork[1]", "share is 1.5"},
        {[](Json& a) { a[1]["place"] = "uv"; }, "artwork[1]", "only pictures"},
        {[](Json& a) { a[1]["place"] = "there"; }, "artwork[1].place", "uv"},
        {[](Json& a) {
             a[0]["place"]["up"] = {0, 0, 2};
         },
         "artwork[0]",
         "along its direction"},
        {[](Json& a) {
             a[0]["place"]["direction"] = {0, 0, 0};
         },
         "artwork[0]",
         "no length"},
        {[](Json& a) {
             a[0]["place"]["centre_mm"] = {0, 0};
         },
         "artwork[0].place.centre_mm",
         ""},
        {[](Json& a) { a[0]["place"]["side"] = 1; }, "artwork[0].place", "side"},
        {[](Json& a) { a[4]["use"] = "bumps"; },
         "artwork[4].use",
         "cover, colours, roughness, relief"},
        {[](Json& a) { a[6]["paint"] = "red"; }, "artwork[6]", "relief has the paint red"},
        {[](Json& a) { a[6]["depth"] = 20; }, "artwork[6]", "depth is 20"},
        {[](Json& a) { a[4].erase("picture"); }, "artwork[4].picture", ""},
        {[](Json& a) { a[4]["picture"] = ""; }, "artwork[4]", "expected a file"},
        {[](Json& a) { a[4]["repeat"] = 1; }, "artwork[4].repeat", ""},
        {[](Json& a) { a[0] = 3; }, "artwork[0]", ""},
        {[](Json& a) { a = Json::object(); }, "artwork", ""},
        {[](Json& a) {
             for (int k = 0; k < 40; ++k) a.push_back(a[0]);
         },
         "artwork",
         "47 artworks"}};
    for (const Case& one : cases) {
        Json json = liveried_look();
        one.change(json["artwork"]);
        EXPECT_TRUE(
            fails_with([&] { look_of(json); }, {"look.json", one.field, one.part_of_message}));
    }
}

}  // namespace
}  // namespace livery
