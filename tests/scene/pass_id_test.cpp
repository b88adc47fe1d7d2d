#include <set>
#include <stdexcept>

#include <gtest/gtest.h>

#include "scene/frame_plan.h"

namespace livery {
namespace {

TEST(PassId, IsWordedByAllThatTellsItFromOthers) {
    EXPECT_EQ(to_string(PassKind::surface_map), "surface-map");
    PassId light(PassKind::light_visibility);
    EXPECT_EQ(to_string(light), "light-visibility");
    light.light = 0;
    EXPECT_EQ(to_string(light), "key-visibility");
    light.light = 2;
    EXPECT_EQ(to_string(light), "light-3-visibility");
    PassId shading(PassKind::shade, "body", ReflectanceModel::car_paint, true);
    EXPECT_EQ(to_string(shading), "shade:body:car-paint+glints");
    shading.artwork = 0;
    EXPECT_EQ(to_string(shading), "shade:body:artwork-1:car-paint+glints");
    EXPECT_EQ(to_string(PassId(PassKind::prepare, "", ReflectanceModel::ggx)), "prepare:ggx");
    EXPECT_THROW(to_string(static_cast<PassKind>(99)), std::invalid_argument);
}

TEST(PassId, EveryKindHasItsOwnWords) {
    std::set<std::string> words;
    for (int kind = 0; kind <= static_cast<int>(PassKind::prepare); ++kind) {
        EXPECT_TRUE(words.insert(to_string(static_cast<PassKind>(kind))).second) << kind;
    }
}

}  // namespace
}  // namespace livery
