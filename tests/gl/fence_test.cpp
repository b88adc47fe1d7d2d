// A fence passes a finished texture from one thread's context to another's.
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "gl/context.h"
#include "gl/draw.h"
#include "gl/program.h"
#include "gl/read_back.h"
#include "gl/timer.h"
#include "support/gl_device.h"

namespace livery {
namespace {

/// A pass whose every pixel takes `turns` steps.
Program slow_pass(int turns) {
    auto program = Program::screen_pass({"slow", R"(#version 450 core
uniform int turns;
out vec4 colour;
void main() {
    float sum = gl_FragCoord.x;
    for (int i = 0; i < turns; ++i) sum = fract(sin(sum) * 43758.5453 + float(i));
    colour = vec4(sum < 2.0 ? 0.75 : 0.0);
}
)"});
    program.use();
    program.set("turns", turns);
    return program;
}

struct FenceTest : ::testing::Test {
    FenceTest() { set_gl_checks(true); }
    ~FenceTest() override { set_gl_checks(false); }
    HeadlessContext context{tested_gl()};
};

TEST_F(FenceTest, NothingToWaitForIsReached) {
    const Fence none;
    EXPECT_TRUE(none.is_reached());
    EXPECT_TRUE(none.wait_for(0.0));
    none.wait_on_device();
}

TEST_F(FenceTest, IsReachedWhenTheWorkIsDoneAndNotBefore) {
    const auto program = slow_pass(1500);
    const Texture2D texture(256, 256, TexelFormat::r32f);
    const Framebuffer framebuffer({&texture});
    ScreenPass().run(program, framebuffer);
    const auto fence = Fence::after_everything_so_far();
    EXPECT_FALSE(fence.is_reached()) << "too quick a machine for this test's work";
    EXPECT_FALSE(fence.wait_for(0.001));
    EXPECT_TRUE(fence.wait_for(60.0));
    EXPECT_TRUE(fence.is_reached());
    EXPECT_TRUE(fence.wait_for(0.0));
}

TEST_F(FenceTest, MovesWithItsPoint) {
    const auto program = slow_pass(1500);
    const Texture2D texture(256, 256, TexelFormat::r32f);
    const Framebuffer framebuffer({&texture});
    ScreenPass().run(program, framebuffer);
    auto fence = Fence::after_everything_so_far();
    Fence other(std::move(fence));
    EXPECT_FALSE(other.is_reached());
    Fence third;
    third = std::move(other);
    EXPECT_FALSE(third.is_reached());
    EXPECT_TRUE(third.wait_for(60.0));
}

TEST_F(FenceTest, TheOtherThreadReadsWhatWasDrawnBeforeIt) {
    Texture2D texture(64, 64, TexelFormat::r32f);
    Fence fence;
    HeadlessContext other(tested_gl(), &context);
    other.release();
    context.make_current();
    std::thread drawing([&] {
        other.make_current();
        {
            const auto program = slow_pass(2000);
            const Framebuffer framebuffer({&texture});
            ScreenPass().run(program, framebuffer);
            fence = Fence::after_everything_so_far();
        }
        other.release();
    });
    drawing.join();
    fence.wait_on_device();
    const auto seen = read_floats(texture);
    for (const float value : seen.values) EXPECT_EQ(value, 0.75f);
}

}  // namespace
}  // namespace livery
