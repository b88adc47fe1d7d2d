// What a typed text finds among the paints, and in which order.
#include "appearance/paint_search.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace livery {
namespace {

std::vector<Material> paints() {
    std::vector<Material> list;
    for (const auto& [name, family] :
         std::vector<std::pair<std::string, std::string>>{{"blue metallic", "metallic"},
                                                          {"dark glass", "glass"},
                                                          {"dark red", "solid"},
                                                          {"red", "solid"},
                                                          {"red metallic", "metallic"},
                                                          {"Zoë's Rot", "matte"},
                                                          {"infrared", "matte"}}) {
        list.emplace_back();
        list.back().name = name;
        list.back().family = family;
    }
    return list;
}

std::vector<std::string> found(const std::string& query, const std::string& family = "") {
    const auto list = paints();
    std::vector<std::string> names;
    for (const auto index : search_paints(list, query, family)) names.push_back(list[index].name);
    return names;
}

using Names = std::vector<std::string>;

TEST(PaintSearch, FindsAllInTheirOrderWithoutAQuery) {
    EXPECT_EQ(found("").size(), paints().size());
    EXPECT_EQ(found("  ").front(), "blue metallic");
    EXPECT_EQ(found("", "solid"), (Names{"dark red", "red"}));
}

TEST(PaintSearch, PutsTheBestFirst) {
    EXPECT_EQ(found("red"), (Names{"red", "red metallic", "dark red", "infrared"}));
    EXPECT_EQ(found("me"), (Names{"blue metallic", "red metallic"}));
    // The family answers too, after the names.
    EXPECT_EQ(found("solid"), (Names{"dark red", "red"}));
    EXPECT_EQ(found("glass"), (Names{"dark glass"}));
}

TEST(PaintSearch, WantsEveryWord) {
    EXPECT_EQ(found("metallic red"), (Names{"red metallic"}));
    EXPECT_EQ(found("red-metallic"), (Names{"red metallic"}));
    EXPECT_EQ(found("RED solid").front(), "red");
    EXPECT_TRUE(found("red banana").empty());
    EXPECT_TRUE(found("red", "glass").empty());
}

TEST(PaintSearch, ForgivesOneMistakeInALongWord) {
    for (const char* typed : {"metalic", "metallicc", "emtallic", "netallic", "metsl"}) {
        EXPECT_EQ(found(typed), (Names{"blue metallic", "red metallic"})) << typed;
    }
    EXPECT_TRUE(found("rad").empty());  // three letters: any other word is one mistake away
    EXPECT_TRUE(found("mxtxllic").empty());
}

TEST(PaintSearch, FindsTheNearestColours) {
    const std::vector<glm::dvec3> faces{
        {50, 0, 0}, {50, 60, 30}, {52, 1, 0}, {50, 0, 0}, {20, 0, -50}};
    const auto near = nearest_colours(faces, {50, 0, 0});
    std::vector<std::size_t> order;
    for (const NearPaint& paint : near) order.push_back(paint.index);
    EXPECT_EQ(order, (std::vector<std::size_t>{0, 3, 2, 1, 4}));
    EXPECT_EQ(near[0].de00, 0.0);
    EXPECT_NEAR(near[2].de00, 2.4, 0.4);
    EXPECT_TRUE(nearest_colours({}, {50, 0, 0}).empty());
}

TEST(PaintSearch, TakesAnyBytes) {
    EXPECT_EQ(found("zoë"), (Names{"Zoë's Rot"}));
    EXPECT_TRUE(found("\xff\xfe").empty());
    EXPECT_TRUE(found(std::string(10000, 'x')).empty());
}

}  // namespace
}  // namespace livery
