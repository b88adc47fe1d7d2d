#include "ledger/reflectance_on_gpu.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <string>

#include <fmt/format.h>

#include "appearance/measured/measured_grid.h"
#include "appearance/parameter_table.h"
#include "gl/draw.h"
#include "gl/program.h"
#include "gl/read_back.h"
#include "radiance/measured_textures.h"

namespace livery {

namespace {

constexpr int kColumns = 2048;
constexpr int kRows = 512;  ///< as many pairs at a time as fit on kColumns x kRows texels

/// Exactly this number: decimals would leave the rounding to the driver's compiler.
std::string literal(float value) {
    return fmt::format("uintBitsToFloat({}u)", std::bit_cast<std::uint32_t>(value));
}

std::string literal(const glm::vec3& v) {
    return fmt::format("vec3({}, {}, {})", literal(v.x), literal(v.y), literal(v.z));
}

std::string paint_text(ReflectanceModel model, f32::BsdfParameters p) {
    std::string text = bsdf_glsl(model) + "BsdfParameters paint() {\n    BsdfParameters p;\n";
    for (const ParameterInfo& parameter : parameter_table()) {
        const Components<float> v = parameter.in_f32(p);
        const auto assign = [&](const char* suffix, const std::string& value) {
            text += fmt::format("    p.{}{} = {};\n", parameter.name, suffix, value);
        };
        switch (parameter.kind) {
            case ParameterKind::colour:
                assign("", literal(glm::vec3(*v[0], *v[1], *v[2])));
                break;
            case ParameterKind::number:
                assign("", literal(*v[0]));
                break;
            case ParameterKind::pair:
                assign("_x", literal(*v[0]));
                assign("_y", literal(*v[1]));
                break;
        }
    }
    return text + "    return p;\n}\n#define VALUE(wi, wo) bsdf_eval(paint(), wi, wo)\n";
}

constexpr const char* kBody = R"(
uniform sampler2D toward_light;
uniform sampler2D toward_eye;
layout(location = 0) out vec4 value;
void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    vec3 wi = texelFetch(toward_light, at, 0).xyz;
    vec3 wo = texelFetch(toward_eye, at, 0).xyz;
    value = vec4(VALUE(wi, wo), 1.0);
}
)";

void append(std::vector<float>& texels, const glm::dvec3& v) {
    texels.insert(
        texels.end(),
        {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z), 0.0f});
}

/// Runs a program with kBody over the pairs. The context and the program's other inputs are set.
std::vector<glm::dvec3> evaluate_pairs(Program& program,
                                       std::span<const DirectionPair> pairs,
                                       const Progress& progress) {
    std::vector<glm::dvec3> values;
    values.reserve(pairs.size());
    Texture2D toward_light(kColumns, kRows, TexelFormat::rgba32f);
    Texture2D toward_eye(kColumns, kRows, TexelFormat::rgba32f);
    const Texture2D target(kColumns, kRows, TexelFormat::rgba32f);
    const Framebuffer framebuffer({&target});
    const ScreenPass pass;
    constexpr auto kChunk = static_cast<std::size_t>(kColumns) * static_cast<std::size_t>(kRows);
    std::vector<float> light, eye;
    for (std::size_t begin = 0; begin < pairs.size(); begin += kChunk) {
        progress.update(static_cast<double>(begin) / static_cast<double>(pairs.size()),
                        "evaluating");
        const std::size_t count = std::min(kChunk, pairs.size() - begin);
        const int rows = static_cast<int>((count + kColumns - 1) / kColumns);
        light.clear();
        eye.clear();
        for (const DirectionPair& pair : pairs.subspan(begin, count)) {
            append(light, pair.wi);
            append(eye, pair.wo);
        }
        const PixelRect rect{0, 0, kColumns, rows};
        const auto texels = static_cast<std::size_t>(kColumns) * static_cast<std::size_t>(rows);
        light.resize(4 * texels);  // below the horizon: nothing is evaluated
        eye.resize(4 * texels);
        toward_light.upload(light, rect);
        toward_eye.upload(eye, rect);
        toward_light.bind(0);
        toward_eye.bind(1);
        program.use();
        program.set("toward_light", 0);
        program.set("toward_eye", 1);
        DrawState state;
        state.scissor = rect;
        pass.run(program, framebuffer, state);
        const ImageF picture = read_floats(target);
        for (std::size_t k = 0; k < count; ++k) {
            const float* v = picture.values.data() + 4 * k;
            values.emplace_back(v[0], v[1], v[2]);
        }
    }
    return values;
}

}  // namespace

std::vector<glm::dvec3> reflectance_on_gpu(ReflectanceModel model,
                                           const BsdfParameters& parameters,
                                           std::span<const DirectionPair> pairs,
                                           GlDevice device,
                                           const Progress& progress) {
    const HeadlessContext context(device);
    Program program = Program::screen_pass(
        {"brdf.frag", "#version 450 core\n" + paint_text(model, parameters) + kBody});
    return evaluate_pairs(program, pairs, progress);
}

std::vector<glm::dvec3> reflectance_on_gpu(const MeasuredGrid& grid,
                                           std::span<const DirectionPair> pairs,
                                           GlDevice device,
                                           const Progress& progress) {
    const HeadlessContext context(device);
    const Texture2D texture = texture_of(grid);
    texture.bind(2);
    Program program =
        Program::screen_pass({"measured.frag",
                              "#version 450 core\n" + measured_glsl() +
                                  "uniform sampler2DArray measured_grid;\n"
                                  "#define VALUE(wi, wo) measured_eval(measured_grid, wi, wo)\n" +
                                  kBody});
    program.use();
    program.set("measured_grid", 2);
    return evaluate_pairs(program, pairs, progress);
}

}  // namespace livery
