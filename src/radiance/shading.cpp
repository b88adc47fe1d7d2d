#include "radiance/shading.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>
#include <span>
#include <string>

#include <fmt/format.h>
#include <glm/gtc/type_ptr.hpp>

#include "appearance/bsdf.h"
#include "core/paths.h"
#include "radiance/glints.h"
#include "radiance/light/environment_filter.h"
#include "radiance/light/mirror_quadrature.h"

namespace livery {

void MeasuredTextures::bind(const std::shared_ptr<const MeasuredPaint>& paint, unsigned unit) {
    std::erase_if(textures_, [](const auto& known) { return known.first.expired(); });
    auto found = std::find_if(textures_.begin(), textures_.end(), [&](const auto& known) {
        return known.first.lock() == paint;
    });
    if (found == textures_.end()) {
        textures_.emplace_back(paint, texture_of(paint->grid));
        found = textures_.end() - 1;
    }
    found->second.bind(unit);
}

Texture2D texture_of(const MeasuredGrid& grid) {
    const auto [rows, layers, columns] = grid.size;
    Texture2D texture({columns, rows, layers, 1}, TexelFormat::rgba32f);
    const std::size_t of_layer = grid.texels.size() / static_cast<std::size_t>(layers);
    for (int layer = 0; layer < layers; ++layer) {
        texture.upload(
            std::span(grid.texels).subspan(static_cast<std::size_t>(layer) * of_layer, of_layer),
            0,
            layer);
    }
    return texture;
}

namespace {

/// What shade.glsl is told of the model.
std::string defines_of(const ModelInfo& model) {
    if (!model.prepared.type) return "#define ANY_MODEL\n";
    return fmt::format("#define PREPARED {}\n{}",
                       model.prepared.type,
                       model.same_from_all_sides ? "#define LAMBERT\n" : "");
}

/// Light from all around is looked up under no smaller one.
constexpr float kLowestCosine = 1e-4f;

std::string shipped_text(const char* file) {
    return read_text_file(shipped_path(std::filesystem::path("shaders") / file));
}

/// The first of four lobes and the shares of those after it.
glm::vec4 mirror_layers(float alpha, MirrorMixing mixing) {
    const MirrorMix mix = mirror_mix(static_cast<double>(alpha), mixing);
    return {static_cast<float>(mix.first), mix.share[1], mix.share[2], mix.share[3]};
}

}  // namespace

bool has_own_shading(ReflectanceModel model) { return model_info(model).prepared.type != nullptr; }

float exposure_of(double exposure_ev, std::span<const float> numbers) {
    const bool good =
        std::all_of(numbers.begin(), numbers.end(), [](float v) { return !std::isnan(v); });
    return good ? static_cast<float>(std::exp2(exposure_ev))
                : std::numeric_limits<float>::quiet_NaN();
}

PaintUniforms uniforms_of(const Material& material, double exposure_ev, MirrorMixing mixing) {
    PaintUniforms u;
    u.paint = model_info(material.model).prepared.of(parameters_of(material));
    u.exposure = exposure_of(exposure_ev, u.paint.numbers);
    for (std::size_t lobe = 0; lobe < u.paint.lobe_slopes.size(); ++lobe) {
        // A lobe that reflects nothing reads what is there for another one
        std::size_t of = lobe;
        while (!reads_layers(u.paint, of)) of = (of + 1) % u.paint.lobe_slopes.size();
        const glm::vec2 slopes = u.paint.lobe_slopes[of];
        u.lobe_layers.at(lobe) = mirror_layers(std::sqrt(slopes.x * slopes.y), mixing);
    }
    return u;
}

namespace {

/// `weights_under` a cosine are those of the model. What is mirrored comes with GGX's own
/// correction, which changes slowly with the cosine.
template <typename Real, typename WeightsUnder>
void tabulate_weights(float lobe_alpha,
                      const WeightsUnder& weights_under,
                      std::array<glm::vec<3, Real>, kEnvironmentWeights>& sky,
                      std::array<glm::vec<3, Real>, kEnvironmentWeights>& mirror) {
    constexpr int kApart = 4;
    std::array<Real, (kEnvironmentWeights - 1) / kApart + 1> correction;
    const auto root_of = [](std::size_t k) {
        return static_cast<Real>(k) / static_cast<Real>(kEnvironmentWeights - 1);
    };
    for (std::size_t i = 0; i < correction.size(); ++i) {
        const auto root = static_cast<double>(root_of(i * kApart));
        correction[i] = static_cast<Real>(
            mirror_correction(root * root, std::max(static_cast<double>(lobe_alpha), 0.01)));
    }
    for (std::size_t k = 0; k < sky.size(); ++k) {
        const Real t = root_of(k);
        const auto weights = weights_under(std::max(t * t, static_cast<Real>(kLowestCosine)));
        const std::size_t below = std::min(k / kApart, correction.size() - 2);
        const Real past = static_cast<Real>(k) / kApart - static_cast<Real>(below);
        sky[k] = weights.diffuse;
        mirror[k] = (weights.specular + weights.coat) /
                    std::lerp(correction[below], correction[below + 1], past);
    }
}

}  // namespace

AnyModelUniforms any_model_uniforms_of(const Material& material,
                                       double exposure_ev,
                                       MirrorMixing mixing) {
    const PaintBsdf bsdf = bsdf_of(material);
    AnyModelUniforms u;
    u.exposure = static_cast<float>(std::exp2(exposure_ev));
    u.paint = bsdf.parameters;
    u.measured = bsdf.measured;
    u.lobe_alpha = lobe_alpha(bsdf);
    u.base_layers = mirror_layers(u.lobe_alpha, mixing);
    tabulate_weights(
        u.lobe_alpha,
        [&](float cosine) { return environment_weights(bsdf, cosine); },
        u.sky_weight,
        u.mirror_weight);
    return u;
}

EnvironmentWeights environment_weights_in_double(const Material& material) {
    const PaintBsdf bsdf = bsdf_of(material);
    EnvironmentWeights weights;
    tabulate_weights(
        lobe_alpha(bsdf),
        [&](double cosine) {
            if (!bsdf.measured) {
                return model_info(bsdf.model).f64.environment(widened(bsdf.parameters), cosine);
            }
            // A measurement's are in a table, from one cosine of which to the next is rounding
            const auto of_table = environment_weights(bsdf, static_cast<float>(cosine));
            return f64::BsdfEnvironment{of_table.diffuse, of_table.specular, of_table.coat};
        },
        weights.sky,
        weights.mirror);
    return weights;
}

namespace {

/// Where each of PreparedPaint::numbers goes.
const std::vector<PreparedField>& uniform_fields(ReflectanceModel model) {
    static std::map<ReflectanceModel, std::vector<PreparedField>> known;
    static std::mutex mutex;
    const std::scoped_lock lock(mutex);
    std::vector<PreparedField>& fields = known[model];
    if (fields.empty()) {
        fields = prepared_fields(model);
        for (PreparedField& field : fields) field.name = "u_paint." + field.name;
    }
    return fields;
}

/// Above all units that the inputs of a fragment take.
constexpr int kMeasuredUnit = 8;
constexpr unsigned kArtworkUnit = 9;

void set_any_paint(Program& program,
                   const Material& material,
                   double exposure_ev,
                   MirrorMixing mixing,
                   MeasuredTextures& measured) {
    AnyModelUniforms u = any_model_uniforms_of(material, exposure_ev, mixing);
    program.set("u_exposure", u.exposure);
    program.set("u_sky_weight", std::span<const glm::vec3>(u.sky_weight));
    program.set("u_mirror_weight", std::span<const glm::vec3>(u.mirror_weight));
    program.set("u_base_layers", u.base_layers);
    program.set("u_lobe_alpha", u.lobe_alpha);
    if (u.measured) {
        program.set("u_measured", kMeasuredUnit);
        measured.bind(u.measured, kMeasuredUnit);
        return;
    }
    for (const ParameterInfo& parameter : parameter_table()) {
        const Components<float> v = parameter.in_f32(u.paint);
        const auto name = [&](const char* suffix) {
            return fmt::format("u_paint.{}{}", parameter.name, suffix);
        };
        switch (parameter.kind) {
            case ParameterKind::colour:
                program.set(name(""), glm::vec3(*v[0], *v[1], *v[2]));
                break;
            case ParameterKind::number:
                program.set(name(""), *v[0]);
                break;
            case ParameterKind::pair:
                program.set(name("_x"), *v[0]);
                program.set(name("_y"), *v[1]);
                break;
        }
    }
}

}  // namespace

void set_paint(Program& program,
               const Material& material,
               double exposure_ev,
               MirrorMixing mixing,
               MeasuredTextures& measured) {
    if (!has_own_shading(material.model)) {
        return set_any_paint(program, material, exposure_ev, mixing, measured);
    }
    const PaintUniforms u = uniforms_of(material, exposure_ev, mixing);
    program.set("u_exposure", u.exposure);
    program.set("u_lobe_layers", std::span<const glm::vec4>(u.lobe_layers));
    const float* at = u.paint.numbers.data();
    for (const PreparedField& field : uniform_fields(material.model)) {
        if (field.count == 1) {
            program.set(field.name, *at);
        } else {
            program.set(field.name, glm::make_vec3(at));
        }
        at += field.count;
    }
}

Program make_shading_program(const ShadingKey& key, ShadingSource source) {
    const auto [model, lights, surroundings, over, relief, glints] = key;
    const bool raster = source == ShadingSource::raster;
    const std::string defines = fmt::format(
        "#define LIGHTS {}\n#define LIGHT_COUNT LIGHTS\n#define ENVIRONMENT {}\n"
        "#define MIRRORED {}\n"
        "#define VEC4 vec4\n#define UNIFORM uniform\n"
        "#define LAYERS {}\n#define FIRST_ALPHA {:.8f}\n#define MESH_ROW {}\n"
        "#define WEIGHTS {}\n#define MIRRORS {}\n#define MIRROR_LOBES {}\n"
        "#define MIRROR_LAYERS {}\n#define MOST_LOBES {}\n"
        "#define BSDF_TURN2 R({:.1f})\n",
        lights,
        surroundings == Surroundings::none ? 0 : 1,
        surroundings == Surroundings::mirrored ? 1 : 0,
        kLayerAlphas.size(),
        kLayerAlphas[1],
        kMeshRow,
        kEnvironmentWeights,
        model_info(model).mirrors() ? 1 : 0,
        kMirrorAlphas.size(),
        kMirrorLayers,
        kMostLobes,
        lobe_turn_squared(model_info(model)));
    std::string text =
        "#version 450 core\n" + bsdf_glsl(model) + defines + defines_of(model_info(model));
    if (over) text += "#define OVER 1\n";
    if (relief) text += "#define RELIEF 1\n";
    if (raster && (over || relief)) {
        text += shipped_text("artwork/cover.glsl") + shipped_text("artwork/place.glsl");
    }
    if (has_own_shading(model) && model_info(model).mirrors())
        text += shipped_text("radiance/disc.glsl");
    if (glints) text += "#define GLINTS true\n" + shipped_text("radiance/glints.glsl");
    if (raster)
        text += shipped_text("bsdf/seen_from.glsl") + shipped_text("radiance/mesh_texels.glsl") +
                shipped_text("radiance/lens.glsl");
    text += shipped_text(raster ? "radiance/inputs_raster.glsl" : "radiance/inputs_packed.glsl");
    text += shipped_text("radiance/shade.glsl");
    if (over) {
        text += shipped_text(raster ? "artwork/inputs_raster.glsl" : "artwork/inputs_packed.glsl");
        text += shipped_text("artwork/over.glsl");
    }
    text += fmt::format(
        "layout(location = 0) out vec4 radiance;\n"
        "void main() {{\n    {}radiance = {};\n}}\n",
        raster ? "prepare_sample();\n    " : "",
        over ? "over_what_lies_below()" : "vec4(shaded(), 1.0)");
    const ShaderSource fragment{
        fmt::format("shade {}{}", model_info(model).name, glints ? "+glints" : ""), text};
    if (!raster) return Program::screen_pass(fragment);
    return Program(load_shader("radiance/raster_part.vert", {}), fragment);
}

Program& ShadingPrograms::program_for(const ShadingKey& key) {
    const auto found = programs_.find(key);
    if (found != programs_.end()) return found->second;
    return programs_.emplace(key, make_shading_program(key, ShadingSource::packed)).first->second;
}

ShadingKey ShadingPrograms::key_of(const Material& material,
                                   const ShadingInputs& inputs,
                                   bool over) {
    const ModelInfo& model = model_info(material.model);
    ShadingKey key{.model = material.model, .over = over};
    if (model.same_from_all_sides) return key;
    key.lights = static_cast<int>(inputs.light_irradiance.size());
    key.glints = key.lights > 0 && has_glints(material);
    if (inputs.sky) {
        key.surroundings =
            model.mirrors() && inputs.mirror ? Surroundings::mirrored : Surroundings::diffuse;
    }
    return key;
}

void ShadingPrograms::compile(const Material& material, const ShadingInputs& inputs, bool over) {
    if (drawn_.contains(key_of(material, inputs, over))) return;
    if (!nowhere_) {
        nowhere_ = Texture2D(1, 1, TexelFormat::rgba16f);
        nowhere_framebuffer_ = Framebuffer({&nowhere_});
    }
    DrawState state;
    state.scissor = PixelRect{0, 0, 1, 1};
    screen_.run(ready(material, inputs, 0.0, over), nowhere_framebuffer_, state);
    finish_gl();
}

/// With its paint, and its inputs bound.
Program& ShadingPrograms::ready(const Material& material,
                                const ShadingInputs& inputs,
                                double exposure_ev,
                                bool over) {
    const ShadingKey key = key_of(material, inputs, over);
    Program& program = program_for(key);
    drawn_.insert(key);
    set_paint(program, material, exposure_ev, inputs.mirror_mixing, measured_);
    if (model_info(material.model).same_from_all_sides) {
        program.set("u_lit", 0);
        inputs.lit.texture().bind(0);
    } else {
        program.set("u_eye", 0);
        inputs.eye.texture().bind(0);
    }
    if (key.lights > 0) {
        program.set("u_lights", 1);
        inputs.lights.texture().bind(1);
        program.set("u_light_radiance", std::span<const glm::vec3>(inputs.light_irradiance));
        program.set("u_light_radius2", std::span<const float>(inputs.light_radius2));
    }
    if (key.glints) {
        program.set("u_places", 4);
        inputs.places.texture().bind(4);
        program.set("u_glint_density",
                    static_cast<float>(glint_density_on_mock_up(material, inputs.product_scale)));
    }
    if (key.surroundings != Surroundings::none) {
        program.set("u_sky", 2);
        inputs.sky.texture().bind(2);
        if (key.surroundings == Surroundings::mirrored) {
            program.set("u_mirror", 3);
            program.set("u_mirror_unit", inputs.mirror_unit);
            program.set("u_mirror_place", inputs.mirror.places());
            inputs.mirror.texture().bind(3);
        }
    }
    return program;
}

void ShadingPrograms::shade(const Material& material,
                            const ShadingInputs& inputs,
                            double exposure_ev,
                            const PixelRect& rectangle,
                            const Framebuffer& target) {
    if (rectangle.height == 0) return;
    Program& program = ready(material, inputs, exposure_ev, false);
    DrawState state;
    state.scissor = rectangle;
    screen_.run(program, target, state);
}

void set_coat(Program& program, const ArtworkCoat& coat) {
    program.set("u_artwork_layer", static_cast<int>(coat.layer));
    program.set("u_of", glm::vec3(coat.of_colour, coat.of_alpha, coat.of_cover));
}

void ShadingPrograms::shade(const ArtworkCoat& coat,
                            const InputLayers& means,
                            const ShadingInputs& inputs,
                            double exposure_ev,
                            const PixelRect& rectangle,
                            const Framebuffer& target) {
    if (rectangle.height == 0) return;
    Program& program = ready(coat.material, inputs, exposure_ev, true);
    set_coat(program, coat);
    program.set("u_artwork", static_cast<int>(kArtworkUnit));
    means.texture().bind(kArtworkUnit);
    DrawState state;
    state.scissor = rectangle;
    state.blend = Blend::over;
    screen_.run(program, target, state);
}

}  // namespace livery
