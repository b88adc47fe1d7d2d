// What the frame thread tells when a frame cannot be drawn.
#include "live/frame_thread_fixture.h"

namespace livery {
namespace {

TEST_F(FrameThreadTest, AProblemKeepsTheLastGoodPicture) {
    start();
    const auto good = gallery_.whole(show());
    ASSERT_TRUE(good);
    const FrameDescription sound = description_;
    const auto expect_problem = [&](const std::string& text) {
        const auto number = show();
        const auto frame = gallery_.wait_for(
            [&](const auto& f) { return f.number == number && !f.problem.empty(); });
        ASSERT_TRUE(frame) << text;
        EXPECT_NE(frame->problem.find(text), std::string::npos) << frame->problem;
        EXPECT_EQ(frame->pictures, good->pictures);
        EXPECT_EQ(frame->drive_texture, good->drive_texture);
        const auto next = description_.number;
        description_ = sound;
        description_.number = next;
        const auto again = gallery_.whole(show());
        ASSERT_TRUE(again);
        EXPECT_EQ(again->problem, "");
        EXPECT_EQ(drive(*again).values, drive(*good).values);
    };
    description_.scene.part_materials.pop_back();
    expect_problem("1 materials for 2 parts");
    description_.glowing_part = 7;
    expect_problem("part 7 cannot glow: the product has 2");
    description_.setup = nullptr;
    expect_problem("the frame has no projector");
    description_.scene.product = nullptr;
    expect_problem("the frame has no product");
    description_.quality = Quality::reference;
    expect_problem("the reference level is the path tracer's");
    description_.wipe_to = scene_of(two_spheres(), paint_of(ReflectanceModel::ggx, 0.1));
    expect_problem("a wipe shows two looks of one product");
}

TEST_F(FrameThreadTest, AProblemBeforeTheFirstPictureHasNone) {
    start();
    const auto sound = description_;
    description_.scene.part_materials.clear();
    const auto bad = show();
    const auto frame = gallery_.wait_for([&](const auto& f) { return f.number == bad; });
    ASSERT_TRUE(frame);
    EXPECT_NE(frame->problem, "");
    EXPECT_FALSE(frame->pictures);
    EXPECT_EQ(frame->drive_texture, 0u);
    description_ = sound;
    description_.number = bad + 1;
    EXPECT_TRUE(gallery_.whole(show()));
}

}  // namespace
}  // namespace livery
