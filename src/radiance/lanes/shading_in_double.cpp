#include "radiance/lanes/shading_in_double.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>

#include <glm/common.hpp>
#include <glm/exponential.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "appearance/model_table.h"
#include "core/mutation.h"
#include "core/parallel.h"
#include "radiance/glints.h"
#include "radiance/shading.h"

// What the shared source is written in, as plain doubles.
#define REAL double
#define VEC2 glm::dvec2
#define VEC3 glm::dvec3
#define VEC4 glm::dvec4
#define R(x) static_cast<double>(x)
#define FN
#define IN(T) const T&
#define OUT(T) T&
#define INOUT(T) T&
#define PRESENT(x) ((x) > 0.0)
#define WORD std::uint32_t
#define word_of(x) static_cast<std::uint32_t>(static_cast<std::int32_t>(x))
#define unit_of(w) ((static_cast<double>((w) >> 9u) + 0.5) * 0x1p-23)
#define octave_of(x) std::exp2(std::floor(std::log2(x)))
#define UNIFORM
#define IS_NAN(x) ((x) != (x))
#define LIGHTS 1
#define LIGHT_COUNT static_cast<int>(fragments.lights.size())
#define WEIGHTS kEnvironmentWeights

// An unused parameter is normal here: all models share one signature.
#pragma GCC diagnostic ignored "-Wunused-parameter"

namespace livery {
namespace {

using glm::abs, glm::acos, glm::atan, glm::clamp, glm::cos, glm::dot, glm::exp, glm::exp2,
    glm::floor, glm::log, glm::log2, glm::max, glm::min, glm::mix, glm::normalize, glm::pow,
    glm::sin, glm::sqrt;

/// The reflectance models and what goes with them.
struct SourceInDouble {
#include "appearance/bsdf_files.inc"
#include "shaders/radiance/disc.glsl"
#include "shaders/radiance/glints.glsl"
};

/// Arrays of uniforms, by light.
struct IrradianceInDouble {
    const std::vector<glm::vec3>& of_light;
    glm::dvec3 operator[](int k) const { return of_light[static_cast<std::size_t>(k)]; }
};
struct Radius2InDouble {
    const std::vector<float>& of_light;
    double operator[](int k) const { return of_light[static_cast<std::size_t>(k)]; }
};

/// What a fragment reads.
struct LooseFragment {
    const LooseFragments& fragments;
    std::size_t index = 0;
    IrradianceInDouble u_light_radiance{fragments.light_irradiance};
    Radius2InDouble u_light_radius2{fragments.light_radius2};

    explicit LooseFragment(const LooseFragments& its_fragments) : fragments(its_fragments) {}

    glm::dvec3 of_layer(std::size_t layer) const { return fragments.mirror[layer][index]; }
    glm::dvec3 diffuse_light_here() const { return fragments.lit[index]; }
    glm::dvec4 eye_here() const { return fragments.eye[index]; }
    glm::dvec4 light_here(int k) const {
        return fragments.lights[static_cast<std::size_t>(k)][index];
    }
    glm::dvec4 place_here() const { return fragments.places[index]; }
    glm::dvec3 sky_here() const {
        return fragments.sky.empty() ? glm::dvec3(0.0) : glm::dvec3(fragments.sky[index]);
    }
    glm::dvec3 grazing_here(int layer) const {
        return of_layer(kMirrorAlphas.size() + static_cast<std::size_t>(layer));
    }
    glm::dvec3 mirrored_here(const glm::dvec4& layers, double) const {
        if (fragments.sky.empty()) return glm::dvec3(0.0);
        const auto first = static_cast<std::size_t>(layers.x);
        const double left = 1.0 - layers.y - layers.z - layers.w;
        const auto share_of = [&](double share, std::size_t layer) {
            return share == 0.0 ? glm::dvec3(0.0) : share * of_layer(layer);
        };
        const glm::dvec3 sum = share_of(left, first) + share_of(layers.y, first + 1) +
                               share_of(layers.z, first + 2) + share_of(layers.w, first + 3);
        return static_cast<double>(fragments.mirror_unit) * max(sum, glm::dvec3(0.0));
    }
};

#define ENVIRONMENT (fragments.sky.empty() ? 0 : 1)
#define MIRRORED ENVIRONMENT
#define PREPARED Prepared
#define MOST_LOBES kMostLobes
#define GLINTS glints
template <typename Prepared>
struct PreparedInDouble : LooseFragment, SourceInDouble {
    bool glints = false;
    PreparedInDouble(const LooseFragments& its_fragments,
                     const Material& material,
                     double exposure_ev,
                     const Prepared& paint)
        : LooseFragment(its_fragments) {
        u_exposure = std::exp2(exposure_ev);
        u_paint = paint;
        const PaintUniforms in_float =
            uniforms_of(material, exposure_ev, its_fragments.mirror_mixing);
        std::copy(in_float.lobe_layers.begin(), in_float.lobe_layers.end(), u_lobe_layers);
        glints = !its_fragments.lights.empty() && has_glints(material);
        u_glint_density =
            static_cast<float>(glint_density_on_mock_up(material, its_fragments.product_scale));
    }
#include "shaders/radiance/shade.glsl"
};

#define LAMBERT
struct LambertInDouble : LooseFragment, SourceInDouble {
    using Prepared = LambertPrepared;
    LambertInDouble(const LooseFragments& its_fragments, double exposure_ev, const Prepared& paint)
        : LooseFragment(its_fragments) {
        u_exposure = std::exp2(exposure_ev);
        u_paint = paint;
    }
#include "shaders/radiance/shade.glsl"
};
#undef LAMBERT

#undef ENVIRONMENT
#define ENVIRONMENT 1
#undef MIRRORED
#define MIRRORED 1
#define ANY_MODEL
#define MIRRORS 1
#define BSDF_TURN2 turn2
using f64::BsdfParameters, f64::bsdf_widen;
struct AnyModelInDouble : LooseFragment {
    const ModelInfo& model;
    const double turn2 = lobe_turn_squared(model);
    std::shared_ptr<const MeasuredPaint> measured;

    AnyModelInDouble(const LooseFragments& its_fragments,
                     const Material& material,
                     double exposure_ev)
        : LooseFragment(its_fragments),
          model(model_info(material.model)),
          u_exposure(std::exp2(exposure_ev)) {
        const AnyModelUniforms in_float =
            any_model_uniforms_of(material, exposure_ev, its_fragments.mirror_mixing);
        measured = in_float.measured;
        u_paint = widened(in_float.paint);
        u_base_layers = in_float.base_layers;
        u_lobe_alpha = in_float.lobe_alpha;
        const EnvironmentWeights weights = environment_weights_in_double(material);
        std::copy(weights.sky.begin(), weights.sky.end(), u_sky_weight);
        std::copy(weights.mirror.begin(), weights.mirror.end(), u_mirror_weight);
    }
    glm::dvec3 bsdf_eval(const BsdfParameters& p,
                         const glm::dvec3& wi,
                         const glm::dvec3& wo) const {
        return measured ? max(evaluate_in_double(measured->grid, wi, wo), glm::dvec3(0.0))
                        : model.f64.eval(p, wi, wo);
    }
#include "shaders/radiance/shade.glsl"
};

template <typename Shader>
std::vector<glm::dvec3> all_of(const Shader& shader, std::size_t count) {
    std::vector<glm::dvec3> values(count);
    parallel_for(count, 512, [&](std::size_t begin, std::size_t end) {
        Shader own = shader;
        for (own.index = begin; own.index < end; ++own.index) {
            values[own.index] = own.shaded();
        }
    });
    return values;
}

}  // namespace

std::vector<glm::dvec3> shaded_in_double(const Material& material,
                                         const LooseFragments& fragments,
                                         double exposure_ev) {
    SourceInDouble source;
    SourceInDouble::BsdfParameters paint{};
    const auto prepared = [&](const auto& its) {
        return all_of(PreparedInDouble(fragments, material, exposure_ev, its), fragments.size());
    };
    if (has_own_shading(material.model)) {
        const f64::BsdfParameters wide = widened(parameters_of(material));
        static_assert(sizeof wide == sizeof paint);
        std::memcpy(&paint, &wide, sizeof paint);
    }
    switch (material.model) {
        case ReflectanceModel::lambert:
            return all_of(LambertInDouble(fragments, exposure_ev, source.lambert_prepare(paint)),
                          fragments.size());
        case ReflectanceModel::ggx:
            return prepared(source.ggx_prepare(paint));
        case ReflectanceModel::translucent:
            return prepared(source.ggx_exit_prepare(paint));
        case ReflectanceModel::clearcoat:
            return prepared(source.clearcoat_prepare(paint));
        case ReflectanceModel::car_paint:
            return prepared(source.car_paint_prepare(paint));
        default:
            return all_of(AnyModelInDouble(fragments, material, exposure_ev), fragments.size());
    }
}

}  // namespace livery
