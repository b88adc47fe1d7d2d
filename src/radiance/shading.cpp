#include "radiance/shading.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

#include <fmt/format.h>
#include <glm/gtc/type_ptr.hpp>

#include "appearance/model_table.h"
#include "core/paths.h"
#include "radiance/glints.h"
#include "radiance/light/environment_filter.h"
#include "radiance/light/mirror_quadrature.h"

namespace livery {
namespace {

/// Of shade.glsl.
std::string define_of(ReflectanceModel model) {
    if (!has_own_shading(model)) return "ANY_MODEL";
    std::string name = model_info(model).prefix;
    for (char& c : name) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    return name;
}

/// Light from all around is looked up under no smaller one.
constexpr float kLowestCosine = 1e-4f;

std::string shipped_text(const char* file) {
    return read_text_file(shipped_path(std::filesystem::path("shaders") / file));
}

template <typename Uniform, typename Value>
void set(Uniform& uniform, const Value& value) {
    for (int c = 0; c < static_cast<int>(std::size(uniform)); ++c) uniform[c] = value[c];
}

glm::vec3 average_through(const BsdfParameters& p) {
    return glm::vec3(1.0f) - f32::ggx_interface_average(p);
}

/// The first of four lobes and the shares of those after it.
glm::vec4 mirror_layers(float alpha) {
    const MirrorMix mix = mirror_mix(static_cast<double>(alpha));
    return {static_cast<float>(mix.first), mix.share[1], mix.share[2], mix.share[3]};
}

}  // namespace

bool has_own_shading(ReflectanceModel model) {
    return model == ReflectanceModel::lambert || model == ReflectanceModel::ggx ||
           model == ReflectanceModel::clearcoat || model == ReflectanceModel::car_paint;
}

namespace {

/// How the coat and what lies on a diffuse layer weigh it, and the absorption in the coat.
void set_coated(PaintUniforms& u,
                const BsdfParameters& p,
                const glm::vec3& diffuse,
                const glm::vec3& share) {
    const float inverse_index2 = f32::coat_inverse_index_squared(p);
    const float mean_path = f32::coat_path(2.0f / 3.0f, inverse_index2);
    set(u.diffuse, diffuse);
    set(u.sky_diffuse, diffuse * share * f32::coat_absorption(p, mean_path));
    set(u.coat_log_transmittance, glm::log2(glm::max(p.coat_transmittance, glm::vec3(1e-6f))));
    u.coat_inverse_index_squared = inverse_index2;
}

}  // namespace

PaintUniforms uniforms_of(const Material& material, double exposure_ev) {
    const BsdfParameters p = parameters_of(material);
    PaintUniforms u{};
    u.exposure = static_cast<float>(std::exp2(exposure_ev));
    set(u.f0, p.f0);
    set(u.base_layers, mirror_layers(std::sqrt(p.alpha_x * p.alpha_y)));
    set(u.coat_layers, mirror_layers(p.coat_alpha));
    set(u.alpha, glm::vec4(p.alpha_x, p.alpha_y, p.coat_alpha, p.coat_f0));
    if (material.model == ReflectanceModel::ggx) {
        set(u.diffuse, p.diffuse / average_through(p));
        set(u.sky_diffuse, p.diffuse);
    } else if (material.model == ReflectanceModel::clearcoat) {
        set_coated(u,
                   p,
                   f32::coated_diffuse(p, f32::coat_inverse_index_squared(p)),
                   glm::min(average_through(p), glm::vec3(f32::coat_average_transmission(p))));
    } else if (material.model == ReflectanceModel::car_paint) {
        set_coated(u,
                   p,
                   f32::car_paint_pigment(p, f32::coat_inverse_index_squared(p)),
                   f32::car_paint_share(p));
        set(u.flakes, glm::vec4(p.flake_f0, p.flake_alpha));
        set(u.flakes_most, f32::car_paint_most(p));
        set(u.flake_layers, mirror_layers(p.flake_alpha));
        set(u.film, glm::vec2(p.film_nm, p.film_eta));
    } else {
        set(u.diffuse, p.diffuse);
    }
    return u;
}

AnyModelUniforms any_model_uniforms_of(const Material& material, double exposure_ev) {
    const PaintBsdf bsdf = bsdf_of(material);
    AnyModelUniforms u;
    u.exposure = static_cast<float>(std::exp2(exposure_ev));
    u.paint = bsdf.parameters;
    u.measured = bsdf.measured;
    u.lobe_alpha = lobe_alpha(bsdf);
    u.base_layers = mirror_layers(u.lobe_alpha);
    // What is mirrored comes with GGX's own correction; it changes slowly with the cosine
    constexpr int kApart = 4;
    std::array<float, (kEnvironmentWeights - 1) / kApart + 1> correction;
    const auto root_of = [](std::size_t k) {
        return static_cast<float>(k) / static_cast<float>(kEnvironmentWeights - 1);
    };
    for (std::size_t i = 0; i < correction.size(); ++i) {
        const auto root = static_cast<double>(root_of(i * kApart));
        correction[i] = static_cast<float>(
            mirror_correction(root * root, std::max(static_cast<double>(u.lobe_alpha), 0.01)));
    }
    for (std::size_t k = 0; k < u.sky_weight.size(); ++k) {
        const float t = root_of(k);
        const BsdfEnvironment weights = environment_weights(bsdf, std::max(t * t, kLowestCosine));
        const std::size_t below = std::min(k / kApart, correction.size() - 2);
        const float past = static_cast<float>(k) / kApart - static_cast<float>(below);
        u.sky_weight[k] = weights.diffuse;
        u.mirror_weight[k] = (weights.specular + weights.coat) /
                             std::lerp(correction[below], correction[below + 1], past);
    }
    return u;
}

namespace {

/// Above all units that the inputs of a fragment take.
constexpr int kMeasuredUnit = 8;
constexpr unsigned kArtworkUnit = 9;

void set_any_paint(Program& program,
                   const Material& material,
                   double exposure_ev,
                   MeasuredTextures& measured) {
    AnyModelUniforms u = any_model_uniforms_of(material, exposure_ev);
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
               MeasuredTextures& measured) {
    if (!has_own_shading(material.model)) {
        return set_any_paint(program, material, exposure_ev, measured);
    }
    const PaintUniforms u = uniforms_of(material, exposure_ev);
    program.set("u_exposure", u.exposure);
    program.set("u_diffuse", glm::make_vec3(u.diffuse));
    program.set("u_sky_diffuse", glm::make_vec3(u.sky_diffuse));
    program.set("u_f0", glm::make_vec3(u.f0));
    program.set("u_alpha", glm::make_vec4(u.alpha));
    program.set("u_base_layers", glm::make_vec4(u.base_layers));
    program.set("u_coat_layers", glm::make_vec4(u.coat_layers));
    program.set("u_flakes", glm::make_vec4(u.flakes));
    program.set("u_flakes_most", glm::make_vec3(u.flakes_most));
    program.set("u_flake_layers", glm::make_vec4(u.flake_layers));
    program.set("u_has_film", u.film[0] > 0.0f ? 1 : 0);
    program.set("u_film", glm::make_vec2(u.film));
    program.set("u_coat_log_transmittance", glm::make_vec3(u.coat_log_transmittance));
    program.set("u_coat_inverse_index_squared", u.coat_inverse_index_squared);
}

Program make_shading_program(const ShadingKey& key, ShadingSource source) {
    const auto [model, lights, environment, over, relief, glints] = key;
    const bool raster = source == ShadingSource::raster;
    const std::string defines = fmt::format(
        "#define {} 1\n#define LIGHTS {}\n#define LIGHT_COUNT LIGHTS\n#define ENVIRONMENT {}\n"
        "#define VEC4 vec4\n#define UNIFORM uniform\n"
        "#define LAYERS {}\n#define FIRST_ALPHA {:.8f}\n#define MESH_ROW {}\n"
        "#define WEIGHTS {}\n#define MIRRORS {}\n#define MIRROR_LOBES {}\n"
        "#define BSDF_TURN2 R({:.1f})\n",
        define_of(model),
        lights,
        environment ? 1 : 0,
        kLayerAlphas.size(),
        kLayerAlphas[1],
        kMeshRow,
        kEnvironmentWeights,
        model_info(model).mirrors() ? 1 : 0,
        kMirrorAlphas.size(),
        lobe_turn_squared(model_info(model)));
    std::string text = "#version 450 core\n" + bsdf_glsl(model) + defines;
    if (over) text += "#define OVER 1\n";
    if (relief) text += "#define RELIEF 1\n";
    if (raster && (over || relief)) {
        text += shipped_text("artwork/cover.glsl") + shipped_text("artwork/place.glsl");
    }
    if (has_own_shading(model) && model_info(model).mirrors())
        text += shipped_text("radiance/disc.glsl");
    if (glints) text += "#define GLINTS 1\n" + shipped_text("radiance/glints.glsl");
    if (raster)
        text += shipped_text("radiance/mesh_texels.glsl") + shipped_text("radiance/lens.glsl");
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
    if (model.same_from_all_sides) return {material.model, 0, false, over, false, false};
    const bool lights = !inputs.light_irradiance.empty();
    return {material.model,
            static_cast<int>(inputs.light_irradiance.size()),
            static_cast<bool>(model.mirrors() ? inputs.mirror : inputs.sky),
            over,
            false,
            lights && has_glints(material)};
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
    const int lights = std::get<1>(key);
    Program& program = program_for(key);
    drawn_.insert(key);
    set_paint(program, material, exposure_ev, measured_);
    if (model_info(material.model).same_from_all_sides) {
        program.set("u_lit", 0);
        inputs.lit.texture().bind(0);
    } else {
        program.set("u_eye", 0);
        inputs.eye.texture().bind(0);
    }
    if (lights > 0) {
        program.set("u_lights", 1);
        inputs.lights.texture().bind(1);
        program.set("u_light_radiance", std::span<const glm::vec3>(inputs.light_irradiance));
        program.set("u_light_radius2", std::span<const float>(inputs.light_radius2));
    }
    if (std::get<5>(key)) {
        program.set("u_places", 4);
        inputs.places.texture().bind(4);
        program.set("u_glint_density",
                    static_cast<float>(glint_density_on_mock_up(material, inputs.product_scale)));
    }
    if (std::get<2>(key)) {
        program.set("u_sky", 2);
        inputs.sky.texture().bind(2);
        if (model_info(material.model).mirrors()) {
            program.set("u_mirror", 3);
            program.set("u_mirror_unit", inputs.mirror_unit);
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
