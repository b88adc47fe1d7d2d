#include "appearance/model_table.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace livery {

namespace {

// The prefix of a model's functions, and the functions in both precisions.
#define LIVERY_BSDF_OF(space, Real, Vec3, prefix)                                \
    {                                                                            \
        [](const space::BsdfParameters& p, const Vec3& wi, const Vec3& wo) {     \
            return space::prefix##_eval(p, wi, wo);                              \
        },                                                                       \
            [](const space::BsdfParameters& p, const Vec3& wo, const Vec3& u) {  \
                return space::prefix##_sample(p, wo, u);                         \
            },                                                                   \
            [](const space::BsdfParameters& p, const Vec3& wi, const Vec3& wo) { \
                return space::prefix##_pdf(p, wi, wo);                           \
            },                                                                   \
            [](const space::BsdfParameters& p, Real mu) {                        \
                return space::prefix##_environment(p, mu);                       \
            }                                                                    \
    }
#define LIVERY_BSDF(prefix)                                 \
#prefix, LIVERY_BSDF_OF(f32, float, glm::vec3, prefix), \
        LIVERY_BSDF_OF(f64, double, glm::dvec3, prefix)

/// In the place of a formula's functions.
template <typename Real, typename Vec3, typename Parameters, typename Environment>
BsdfFunctions<Real, Vec3, Parameters, Environment> no_functions() {
    const auto none = [](const Parameters&, const Vec3&, const Vec3&) -> Vec3 {
        throw std::logic_error("measured reflectance has no formula");
    };
    return {none,
            none,
            [](const Parameters&, const Vec3&, const Vec3&) -> Real {
                throw std::logic_error("measured reflectance has no formula");
            },
            [](const Parameters&, Real) -> Environment {
                throw std::logic_error("measured reflectance has no formula");
            }};
}

constexpr bool kFromAllSides = true, kByDirection = false;
constexpr bool kIsotropic = false, kAnisotropic = true;
constexpr bool kReciprocal = true, kConserving = true;

}  // namespace

const std::vector<ModelInfo>& model_table() {
    static const std::vector<ModelInfo> table = {
        {ReflectanceModel::lambert,
         "lambert",
         "Plain diffuse",
         "The same radiance in all directions.",
         "a plain diffuse paint",
         "no part is plain diffuse",
         {"lambert.glsl"},
         {"diffuse"},
         Lobe::none,
         kIsotropic,
         kFromAllSides,
         kReciprocal,
         kConserving,
         LIVERY_BSDF(lambert)},
        {ReflectanceModel::eon,
         "eon",
         "Rough diffuse",
         "A diffuse surface as rough as plaster (energy-conserving Oren-Nayar).",
         "a rough diffuse paint",
         "no part is rough and diffuse",
         {"eon.glsl"},
         {"diffuse", "diffuse_roughness"},
         Lobe::none,
         kIsotropic,
         kByDirection,
         kReciprocal,
         kConserving,
         LIVERY_BSDF(eon)},
        {ReflectanceModel::ggx,
         "ggx",
         "Glossy or matte",
         "A rough interface (GGX microfacets) over a diffuse layer.",
         "a paint with one glossy lobe",
         "no part uses GGX",
         {"microfacet.glsl", "ggx.glsl"},
         {"diffuse", "f0", "alpha"},
         Lobe::half_alpha,
         kAnisotropic,
         kByDirection,
         kReciprocal,
         kConserving,
         LIVERY_BSDF(ggx)},
        {ReflectanceModel::clearcoat,
         "clearcoat",
         "Clear coat",
         "A clear coat over a rough interface: solid and metallic car paint.",
         "a paint under a clear coat",
         "no paint has a clear coat",
         {"microfacet.glsl", "ggx.glsl", "clearcoat.glsl"},
         {"diffuse", "f0", "alpha", "coat_alpha", "coat_f0", "coat_transmittance"},
         Lobe::half_alpha,
         kAnisotropic,
         kByDirection,
         kReciprocal,
         kConserving,
         LIVERY_BSDF(clearcoat)},
    };
    return table;
}

namespace {

const ModelInfo& measured_info() {
    static const ModelInfo info = {
        ReflectanceModel::measured,
        "measured",
        "Measured",
        "What an instrument measured, drawn as it is.",
        "a measured paint",
        "no part is measured",
        {},
        {},
        Lobe::half_alpha,
        kIsotropic,
        kByDirection,
        kReciprocal,
        !kConserving,
        "measured",
        no_functions<float, glm::vec3, f32::BsdfParameters, f32::BsdfEnvironment>(),
        no_functions<double, glm::dvec3, f64::BsdfParameters, f64::BsdfEnvironment>()};
    return info;
}

}  // namespace

#undef LIVERY_BSDF
#undef LIVERY_BSDF_OF

const ModelInfo& model_info(ReflectanceModel model) {
    if (model == ReflectanceModel::measured) return measured_info();
    const auto& table = model_table();
    const auto index = static_cast<std::size_t>(model);
    if (index >= table.size()) {
        throw std::invalid_argument(fmt::format("there is no reflectance model {}", index));
    }
    return table[index];
}

const ModelInfo* find_model(const std::string& name) {
    const auto& table = model_table();
    const auto found = std::find_if(
        table.begin(), table.end(), [&](const ModelInfo& info) { return info.name == name; });
    if (found != table.end()) return &*found;
    return name == measured_info().name ? &measured_info() : nullptr;
}

std::string model_names() {
    std::vector<const char*> names;
    for (const ModelInfo& info : model_table()) names.push_back(info.name);
    names.push_back(measured_info().name);
    return fmt::format("{}", fmt::join(names, ", "));
}

bool ModelInfo::has(const std::string& parameter) const {
    return std::find(parameters.begin(), parameters.end(), parameter) != parameters.end();
}

float lobe_alpha(const ModelInfo& model, const f32::BsdfParameters& p) {
    const auto of_exponent = [](float x, float y) {
        return std::sqrt(2.0f / (std::sqrt(x * y) + 2.0f));
    };
    switch (model.lobe) {
        case Lobe::none:
            return 1.0f;
        case Lobe::half_alpha:
            return std::sqrt(p.alpha_x * p.alpha_y);
        case Lobe::half_exponent:
            return of_exponent(p.exponent_x, p.exponent_y);
        case Lobe::mirror_exponent:
            return 0.5f * of_exponent(p.exponent_x, p.exponent_y);
    }
    throw std::invalid_argument("unknown kind of lobe");
}

double lobe_turn_squared(const ModelInfo& model) {
    return model.lobe == Lobe::mirror_exponent ? 4.0 : 1.0;
}

}  // namespace livery
