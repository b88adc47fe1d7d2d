#include "ledger/reflectance_values.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <string>

#include <fmt/format.h>

#include "appearance/bsdf.h"
#include "appearance/measured/measured_grid.h"
#include "appearance/parameter_table.h"
#include "core/parallel.h"
#include "gl/draw.h"
#include "gl/program.h"
#include "gl/read_back.h"
#include "radiance/shading.h"

namespace livery {

namespace {

constexpr std::size_t kAtOnce = 1u << 20u;  ///< pairs between two looks at Ctrl-C
constexpr std::size_t kAlbedoSamples = 1u << 15u;
constexpr int kMeasuredPoints = 128;  ///< a side, of an albedo's quadrature

/// Steps of a sequence that fills the unit cube evenly (Roberts 2018, R3): powers of the inverse of
/// the root of x^4 = x + 1.
constexpr double kStep[3] = {0.8191725133961645, 0.6710436067037893, 0.5497004779019703};

DirectionPair rounded_to_float(const DirectionPair& pair) {
    return {glm::dvec3(glm::vec3(pair.wi)), glm::dvec3(glm::vec3(pair.wo))};
}

/// evaluate(pair) for every one, on all threads.
template <typename Evaluate>
std::vector<glm::dvec3> for_each_pair(std::span<const DirectionPair> pairs,
                                      const Progress& progress,
                                      const Evaluate& evaluate) {
    std::vector<glm::dvec3> values(pairs.size());
    for (std::size_t first = 0; first < pairs.size(); first += kAtOnce) {
        progress.update(static_cast<double>(first) / static_cast<double>(pairs.size()),
                        "evaluating");
        parallel_for(
            std::min(kAtOnce, pairs.size() - first), 4096, [&](std::size_t begin, std::size_t end) {
                for (std::size_t k = first + begin; k < first + end; ++k) {
                    values[k] = evaluate(pairs[k]);
                }
            });
    }
    return values;
}

}  // namespace

std::vector<glm::dvec3> reflectance_values(const Material& material,
                                           std::span<const DirectionPair> pairs,
                                           const ReflectanceSettings& settings,
                                           const Progress& progress) {
    const auto in_double = [&](const f64::BsdfParameters& p, const DirectionPair& pair) {
        return evaluate(material.model, p, pair.wi, pair.wo);
    };
    switch (settings.precision) {
        case Precision::gpu:
            return reflectance_on_gpu(
                material.model, parameters_of(material), pairs, settings.gl, progress);
        case Precision::f32:
            return for_each_pair(
                pairs, progress, [&, p = parameters_of(material)](const DirectionPair& pair) {
                    return glm::dvec3(
                        evaluate(material.model, p, glm::vec3(pair.wi), glm::vec3(pair.wo)));
                });
        case Precision::f64:
            break;
    }
    if (settings.round_inputs) {
        return for_each_pair(
            pairs, progress, [&, p = widened(parameters_of(material))](const DirectionPair& pair) {
                return in_double(p, rounded_to_float(pair));
            });
    }
    return for_each_pair(
        pairs, progress, [&, p = parameters_of_f64(material)](const DirectionPair& pair) {
            return in_double(p, pair);
        });
}

std::vector<glm::dvec3> albedo_values(const Material& material,
                                      std::span<const glm::dvec3> wo,
                                      const ReflectanceSettings& settings,
                                      const Progress& progress) {
    const bool rounded_inputs = settings.round_inputs || settings.precision != Precision::f64;
    const f64::BsdfParameters p =
        rounded_inputs ? widened(parameters_of(material)) : parameters_of_f64(material);
    std::vector<glm::dvec3> albedos;
    for (const glm::dvec3& direction : wo) {
        progress.update(static_cast<double>(albedos.size()) / static_cast<double>(wo.size()),
                        "integrating");
        const glm::dvec3 eye = rounded_inputs ? glm::dvec3(glm::vec3(direction)) : direction;
        albedos.push_back(directional_albedo(material.model, p, eye));
    }
    if (settings.precision == Precision::f64) return albedos;

    // The difference alone is integrated with samples, so their noise is as small as it is.
    std::vector<DirectionPair> pairs;
    std::vector<double> weights;
    for (const glm::dvec3& direction : wo) {
        const glm::dvec3 eye(glm::vec3{direction});
        for (std::size_t k = 0; k < kAlbedoSamples; ++k) {
            glm::dvec3 u;
            for (int axis = 0; axis < 3; ++axis) {
                u[axis] = std::fmod(0.5 + kStep[axis] * static_cast<double>(k), 1.0);
            }
            const glm::dvec3 light(glm::vec3(sample(material.model, p, eye, u)));
            const double density = pdf(material.model, p, light, eye);
            pairs.push_back({light, eye});
            weights.push_back(light.z > 0.0 && density > 0.0 ? light.z / density : 0.0);
        }
    }
    ReflectanceSettings in_double = settings;
    in_double.precision = Precision::f64;
    in_double.round_inputs = true;
    const auto values = reflectance_values(material, pairs, settings, progress);
    const auto truth = reflectance_values(material, pairs, in_double, progress);
    for (std::size_t k = 0; k < pairs.size(); ++k) {
        if (weights[k] == 0.0) continue;
        albedos[k / kAlbedoSamples] +=
            (values[k] - truth[k]) * (weights[k] / static_cast<double>(kAlbedoSamples));
    }
    return albedos;
}

std::vector<glm::dvec3> reflectance_values(const MeasuredReflectance& measured,
                                           std::span<const DirectionPair> pairs,
                                           const ReflectanceSettings& settings,
                                           const Progress& progress) {
    if (settings.precision == Precision::f64) {
        return for_each_pair(pairs, progress, [&](const DirectionPair& given) {
            const DirectionPair pair = settings.round_inputs ? rounded_to_float(given) : given;
            return evaluate(measured, pair.wi, pair.wo);
        });
    }
    const MeasuredGrid grid = resampled(measured, {}, progress);
    if (settings.precision == Precision::gpu) {
        return reflectance_on_gpu(grid, pairs, settings.gl, progress);
    }
    return for_each_pair(pairs, progress, [&](const DirectionPair& pair) {
        return glm::dvec3(evaluate(grid, glm::vec3(pair.wi), glm::vec3(pair.wo)));
    });
}

std::vector<glm::dvec3> albedo_values(const MeasuredReflectance& measured,
                                      std::span<const glm::dvec3> wo,
                                      const ReflectanceSettings& settings,
                                      const Progress& progress) {
    std::vector<DirectionPair> pairs;
    std::vector<double> weights;
    std::vector<std::size_t> owners;
    for (std::size_t k = 0; k < wo.size(); ++k) {
        for (const auto& [wi, weight] : directions_by_half_vector(wo[k], kMeasuredPoints)) {
            pairs.push_back({wi, wo[k]});
            weights.push_back(weight);
            owners.push_back(k);
        }
    }
    const auto values = reflectance_values(measured, pairs, settings, progress);
    std::vector<glm::dvec3> albedos(wo.size(), glm::dvec3(0.0));
    for (std::size_t k = 0; k < pairs.size(); ++k) albedos[owners[k]] += weights[k] * values[k];
    return albedos;
}

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
