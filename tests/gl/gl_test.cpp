// The headless context and what the handles promise, on whatever OpenGL is there.
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "gl/context.h"
#include "gl/draw.h"
#include "gl/handles.h"
#include "gl/program.h"
#include "gl/read_back.h"
#include "gl/timer.h"
#include "support/gl_device.h"
#include "support/message_of.h"

namespace livery {
namespace {

class Gl : public ::testing::Test {
  protected:
    Gl() : context_(tested_gl()) { set_gl_checks(true); }
    ~Gl() override { set_gl_checks(false); }
    HeadlessContext context_;
};

TEST(HeadlessContext, WorksWithoutADisplayAndLeavesTheEnvironmentAlone) {
    unsetenv("DISPLAY");
    unsetenv("WAYLAND_DISPLAY");
    unsetenv("LIBGL_ALWAYS_SOFTWARE");
    {
        const HeadlessContext context(GlDevice::software);
        EXPECT_TRUE(context.is_software());
        EXPECT_NE(context.renderer().find("llvmpipe"), std::string::npos) << context.renderer();
        EXPECT_EQ(context.version().substr(0, 3), "4.5") << context.version();
        EXPECT_NE(context.version().find("Core"), std::string::npos) << context.version();
    }
    EXPECT_EQ(std::getenv("LIBGL_ALWAYS_SOFTWARE"), nullptr);
    EXPECT_EQ(std::getenv("DISPLAY"), nullptr);
}

TEST(HeadlessContext, AutomaticAlwaysFindsOne) {
    const HeadlessContext context(GlDevice::automatic);
    EXPECT_FALSE(context.renderer().empty());
}

TEST(HeadlessContext, HardwareIsHardwareOrSaysWhatWasTried) {
    try {
        const HeadlessContext context(GlDevice::hardware);
        EXPECT_FALSE(context.is_software());
    } catch (const std::runtime_error& error) {
        const std::string message = error.what();
        EXPECT_NE(message.find("no graphics card gives OpenGL 4.5"), std::string::npos) << message;
        EXPECT_NE(message.find("Tried:"), std::string::npos) << message;
        EXPECT_NE(message.find("libgl1-mesa-dri"), std::string::npos) << message;
    }
}

TEST(HeadlessContext, TwoLiveSideBySideAndOneOutlivesTheOther) {
    HeadlessContext first(tested_gl());
    Texture2D kept(2, 1, TexelFormat::r32f);
    kept.upload(std::vector<float>{1.0f, 2.0f});
    {
        const HeadlessContext second(tested_gl());
        Texture2D other(1, 1, TexelFormat::r32f);
        other.upload(std::vector<float>{5.0f});
        EXPECT_EQ(read_floats(other).at(0, 0), 5.0f);
    }
    first.make_current();
    EXPECT_EQ(read_floats(kept).at(1, 0), 2.0f);
}

TEST_F(Gl, TexelsComeBackAsTheyWent) {
    const int width = 5, height = 3;
    std::vector<float> values(static_cast<std::size_t>(width * height * 4));
    for (std::size_t i = 0; i < values.size(); ++i) {
        values[i] = -2.0f + 0.37f * static_cast<float>(i);
    }
    Texture2D full(width, height, TexelFormat::rgba32f);
    full.upload(values);
    EXPECT_EQ(read_floats(full).values, values);

    // Half floats hold 11 bits: relative error at most 2^-11 (rounded) or 2^-10 (cut).
    Texture2D half(width, height, TexelFormat::rgba16f);
    half.upload(values);
    const ImageF halves = read_floats(half);
    for (std::size_t i = 0; i < values.size(); ++i) {
        EXPECT_NEAR(halves.values[i], values[i], std::abs(values[i]) * 0x1p-10f) << i;
    }

    std::vector<std::uint8_t> bytes(static_cast<std::size_t>(width * height * 4));
    for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<std::uint8_t>(4 * i);
    Texture2D eight(width, height, TexelFormat::rgba8);
    eight.upload(bytes);
    EXPECT_EQ(read_bytes(eight, 4).values, bytes);
    const Image8 three = read_bytes(eight, 3);
    EXPECT_EQ(three.at(2, 1, 1), bytes[(1 * 5 + 2) * 4 + 1]);

    const std::vector<std::uint32_t> whole = {1u, 0xffffffffu, 7u};
    Texture2D integers(3, 1, TexelFormat::r32ui);
    integers.upload(whole);
    EXPECT_EQ(read_integers(integers).values, whole);
}

TEST_F(Gl, HalfFloatBitsAreTakenAsTheyAre) {
    // 0x3c00 is 1, 0xc000 is -2, 0x7c00 is infinity in IEEE 754 binary16.
    Texture2D half(3, 1, TexelFormat::r16f);
    half.upload(std::vector<std::uint16_t>{0x3c00, 0xc000, 0x7c00});
    const ImageF image = read_floats(half);
    EXPECT_EQ(image.at(0, 0), 1.0f);
    EXPECT_EQ(image.at(1, 0), -2.0f);
    EXPECT_TRUE(std::isinf(image.at(2, 0)));
}

TEST_F(Gl, LayersAndRectanglesGoWhereTheyBelong) {
    Texture2D layers(TextureShape{2, 2, 3, 1}, TexelFormat::r32f);
    for (int layer = 0; layer < 3; ++layer) {
        layers.upload(std::vector<float>(4, static_cast<float>(layer)), 0, layer);
    }
    EXPECT_EQ(read_floats(layers, 0, 2).at(1, 1), 2.0f);
    layers.upload(std::vector<float>{9.0f}, PixelRect{1, 0, 1, 1}, 1);
    const ImageF middle = read_floats(layers, 0, 1);
    EXPECT_EQ(middle.values, (std::vector<float>{1.0f, 9.0f, 1.0f, 1.0f}));
}

TEST_F(Gl, CopiesARectangleAndLeavesTheRest) {
    Texture2D from(4, 3, TexelFormat::rgba16f), to(4, 3, TexelFormat::rgba16f);
    from.upload(std::vector<float>(48, 2.0f));
    to.clear({0.25f, 0.5f, 0.75f, 1.0f});
    copy_texels(from.name(), to, {1, 0, 2, 3});
    copy_texels(from.name(), to, {3, 0, 0, 3});  // nothing
    const ImageF image = read_floats(to);
    for (int y = 0; y < 3; ++y) {
        for (int x = 0; x < 4; ++x) {
            const bool copied = x == 1 || x == 2;
            for (int c = 0; c < 4; ++c) {
                EXPECT_EQ(image.at(x, y, c), copied ? 2.0f : 0.25f * static_cast<float>(c + 1));
            }
        }
    }
}

TEST_F(Gl, RowZeroIsTheTopAndFragCoordIsThePixelCentre) {
    const Program program = Program::screen_pass({"coordinates", R"(#version 450 core
out vec4 colour;
void main() { colour = vec4(gl_FragCoord.xy, 0.0, 1.0); })"});
    Texture2D target(4, 3, TexelFormat::rgba32f);
    const Framebuffer framebuffer({&target});
    const ScreenPass screen;
    screen.run(program, framebuffer);
    const ImageF image = read_floats(target);
    for (int y = 0; y < 3; ++y) {
        for (int x = 0; x < 4; ++x) {
            EXPECT_EQ(image.at(x, y, 0), static_cast<float>(x) + 0.5f);
            EXPECT_EQ(image.at(x, y, 1), static_cast<float>(y) + 0.5f);
        }
    }
}

TEST_F(Gl, ScissorKeepsEverythingElse) {
    const Program program = Program::screen_pass({"one", R"(#version 450 core
out vec4 colour;
void main() { colour = vec4(1.0); })"});
    Texture2D target(6, 5, TexelFormat::rgba8);
    const Framebuffer framebuffer({&target});
    framebuffer.clear_colour(0, 0.0f, 0.0f, 0.0f, 0.0f);
    const ScreenPass screen;
    DrawState state;
    state.scissor = PixelRect{1, 2, 3, 2};
    screen.run(program, framebuffer, state);
    const Image8 image = read_bytes(target, 1);
    int lit = 0;
    for (const std::uint8_t value : image.values) lit += value == 255;
    EXPECT_EQ(lit, 6);
    EXPECT_EQ(image.at(1, 2), 255);
    EXPECT_EQ(image.at(3, 3), 255);
    EXPECT_EQ(image.at(1, 1), 0);
    // A clear after a scissored draw still clears all of it.
    framebuffer.clear_colour(0, 0.0f, 0.0f, 0.0f, 0.0f);
    for (const std::uint8_t value : read_bytes(target, 1).values) EXPECT_EQ(value, 0);
}

TEST_F(Gl, PointsAddUpWithBlendingAndReadBuffersAndBlocks) {
    Program program(ShaderSource{"points", R"(#version 450 core
layout(location = 0) in vec2 position_px;
layout(location = 1) in uint weight;
flat out float value;
uniform vec2 size_px;
layout(std140, binding = 2) uniform Scale { float scale; };
layout(std430, binding = 3) readonly buffer Extra { float extra[]; };
void main() {
    gl_Position = vec4(2.0 * position_px / size_px - 1.0, 0.0, 1.0);
    gl_PointSize = 1.0;
    value = float(weight) * scale + extra[gl_VertexID];
})"},
                    ShaderSource{"points", R"(#version 450 core
flat in float value;
out float colour;
void main() { colour = value; })"});
    struct Point {
        float x, y;
        std::uint32_t weight;
    };
    const std::vector<Point> points = {{0.5f, 0.5f, 1u}, {2.5f, 1.5f, 2u}, {2.5f, 1.5f, 3u}};
    const Buffer buffer(points);
    const Buffer scale(std::vector<float>{10.0f, 0.0f, 0.0f, 0.0f});
    const Buffer extra(std::vector<float>{0.25f, 0.5f, 1.0f});
    VertexArray vertices;
    vertices.floats(0, buffer, 2, sizeof(Point));
    vertices.integers(1, buffer, 1, 4, sizeof(Point), offsetof(Point, weight));
    scale.bind_uniform_block(2);
    extra.bind_storage_block(3);
    Texture2D target(3, 2, TexelFormat::r32f);
    const Framebuffer framebuffer({&target});
    framebuffer.clear_colour(0, 0.0f, 0.0f, 0.0f, 0.0f);
    DrawState state;
    state.blend = Blend::add;
    EXPECT_TRUE(program.set("size_px", glm::vec2(3.0f, 2.0f)));
    EXPECT_FALSE(program.set("no_such_uniform", 1.0f));
    draw(program, vertices, framebuffer, Primitive::points, 0, 3, state);
    const ImageF image = read_floats(target);
    EXPECT_FLOAT_EQ(image.at(0, 0), 10.25f);
    EXPECT_FLOAT_EQ(image.at(2, 1), 20.5f + 31.0f);
    EXPECT_FLOAT_EQ(image.at(1, 0), 0.0f);
}

TEST_F(Gl, IndexedTrianglesCullByThePictureAndKeepTheNearest) {
    Program program(ShaderSource{"depth", R"(#version 450 core
layout(location = 0) in vec3 position_ndc;
flat out float shade;
void main() { gl_Position = vec4(position_ndc, 1.0); shade = position_ndc.z; })"},
                    ShaderSource{"depth", R"(#version 450 core
flat in float shade;
out float colour;
void main() { colour = shade; })"});
    // Rows go down: (-1,-1) is top left; top left, bottom left, bottom right is counter-clockwise.
    const std::vector<float> corners = {-1,
                                        -1,
                                        0.5f,
                                        -1,
                                        3,
                                        0.5f,
                                        3,
                                        -1,
                                        0.5f,  //
                                        -1,
                                        -1,
                                        0.2f,
                                        -1,
                                        3,
                                        0.2f,
                                        3,
                                        -1,
                                        0.2f};
    const Buffer buffer(corners);
    const Buffer indices(std::vector<std::uint32_t>{3, 4, 5, 0, 1, 2});
    VertexArray vertices;
    vertices.floats(0, buffer, 3, 12);
    vertices.indices(indices);
    Texture2D colour(2, 2, TexelFormat::r32f), depth(2, 2, TexelFormat::depth32f);
    const Framebuffer framebuffer({&colour}, &depth);
    framebuffer.clear_colour(0, -1.0f, 0.0f, 0.0f, 0.0f);
    framebuffer.clear_depth();
    DrawState state;
    state.depth_test = true;
    state.cull_back = true;
    draw_indexed(program, vertices, framebuffer, Primitive::triangles, 0, 6, state);
    EXPECT_FLOAT_EQ(read_floats(colour).at(1, 0), 0.2f);
    EXPECT_FLOAT_EQ(read_floats(depth).at(1, 0), 0.6f);

    const Buffer reversed(std::vector<std::uint32_t>{0, 2, 1});
    vertices.indices(reversed);
    framebuffer.clear_colour(0, -1.0f, 0.0f, 0.0f, 0.0f);
    draw_indexed(program, vertices, framebuffer, Primitive::triangles, 0, 3, state);
    EXPECT_FLOAT_EQ(read_floats(colour).at(1, 0), -1.0f);
}

TEST_F(Gl, TimerMeasuresWorkInOrder) {
    const Program program = Program::screen_pass({"work", R"(#version 450 core
out vec4 colour;
uniform float seed;
void main() {
    float v = seed + gl_FragCoord.x;
    for (int i = 0; i < 400; ++i) v = sin(v) + 0.1;
    colour = vec4(v);
})"});
    Texture2D target(256, 256, TexelFormat::rgba16f);
    const Framebuffer framebuffer({&target});
    const ScreenPass screen;
    GlTimer timer;
    EXPECT_FALSE(timer.is_ready());
    timer.start();
    screen.run(program, framebuffer);
    timer.stop();
    const double ms = timer.milliseconds();
    EXPECT_TRUE(timer.is_ready());
    // 26 million sines take some time and not a minute, on any machine.
    EXPECT_GT(ms, 1e-4);
    EXPECT_LT(ms, 60e3);
}

TEST_F(Gl, ComputeWritesStorage) {
    Program program(ShaderSource{"squares", R"(#version 450 core
layout(local_size_x = 4) in;
layout(std430, binding = 0) buffer Values { float values[]; };
void main() { values[gl_GlobalInvocationID.x] *= values[gl_GlobalInvocationID.x]; })"});
    Buffer buffer(std::vector<float>{1, 2, 3, 4, 5, 6, 7, 8});
    buffer.bind_storage_block(0);
    dispatch(program, 2, 1);
    std::array<float, 3> read{};
    buffer.read(read.data(), sizeof(read));
    EXPECT_EQ(read, (std::array<float, 3>{1, 4, 9}));
    const Program copy = Program::screen_pass({"copy", R"(#version 450 core
layout(std430, binding = 0) readonly buffer Values { float values[]; };
out float colour;
void main() { colour = values[int(gl_FragCoord.x)]; })"});
    Texture2D target(8, 1, TexelFormat::r32f);
    const Framebuffer framebuffer({&target});
    ScreenPass().run(copy, framebuffer);
    EXPECT_EQ(read_floats(target).values, (std::vector<float>{1, 4, 9, 16, 25, 36, 49, 64}));
    buffer.clear();
    buffer.read(read.data(), sizeof(read));
    EXPECT_EQ(read, (std::array<float, 3>{}));
    EXPECT_NE(message_of([&] { buffer.read(nullptr, 33); }).find("33 bytes from a buffer of 32"),
              std::string::npos);
}

TEST_F(Gl, ComputeWritesAnImage) {
    const Program program(ShaderSource{"ramp", R"(#version 450 core
layout(local_size_x = 1) in;
layout(binding = 1, rgba8) writeonly uniform image2D picture;
void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    imageStore(picture, at, vec4(at.x / 255.0, at.y / 255.0, 3.0 / 255.0, 1.0));
})"});
    const Texture2D texture(5, 2, TexelFormat::rgba8);
    texture.bind_image(1);
    dispatch(program, 5, 2);
    const Image8 image = read_bytes(texture, 4);
    for (int y = 0; y < 2; ++y) {
        for (int x = 0; x < 5; ++x) {
            EXPECT_EQ(image.at(x, y, 0), x);
            EXPECT_EQ(image.at(x, y, 1), y);
            EXPECT_EQ(image.at(x, y, 2), 3);
            EXPECT_EQ(image.at(x, y, 3), 255);
        }
    }
}

TEST_F(Gl, MistakesAreNamedWithTheirValues) {
    EXPECT_NE(message_of([] { Texture2D(0, 4, TexelFormat::rgba8); }).find("texture of 0x4"),
              std::string::npos);
    EXPECT_NE(message_of([] { Texture2D(1 << 20, 4, TexelFormat::rgba8); }).find("up to"),
              std::string::npos);
    Texture2D texture(2, 2, TexelFormat::rgba32f);
    EXPECT_EQ(message_of([&] { texture.upload(std::vector<float>(15)); }),
              "15 values for 2x2 texels of 4 channels, expected 16");
    EXPECT_EQ(message_of([&] { texture.upload(std::vector<std::uint8_t>(16)); }),
              "texels of a type that the texture's format does not take");
    EXPECT_NE(message_of([&] { texture.upload(std::vector<float>(16), 1); }).find("level 1"),
              std::string::npos);
    EXPECT_EQ(message_of([&] {
                  texture.upload(std::vector<float>(16), PixelRect{1, 0, 2, 2});
              }),
              "texels for a rectangle outside the texture");
    const Texture2D other(3, 2, TexelFormat::rgba32f);
    EXPECT_EQ(message_of([&] {
                  Framebuffer({&texture, &other});
              }),
              "a framebuffer over textures of 2x2 and 3x2");
    EXPECT_EQ(message_of([] { Framebuffer(std::vector<const Texture2D*>{}); }),
              "a framebuffer without textures");
    Buffer buffer(std::vector<float>{1.0f});
    EXPECT_EQ(message_of([&] { buffer.update(std::span<const float>(std::vector<float>(2))); }),
              "8 bytes at 0 for a buffer of 4");
    EXPECT_EQ(message_of([] { Buffer(std::size_t{0}); }), "an empty buffer");
}

TEST_F(Gl, ErrorsSurfaceWhereTheyHappen) {
    EXPECT_NE(message_of([] { bind_texture(1u << 20u, 0); }).find("GL_INVALID"), std::string::npos);
    // The error was consumed: the next call is clean.
    EXPECT_EQ(message_of([] { throw_on_gl_error("nothing"); }), "nothing thrown");
}

}  // namespace
}  // namespace livery
