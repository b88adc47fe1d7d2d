#include "mesh/gltf/gltf_words.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/common.hpp>

#include "appearance/model_table.h"
#include "appearance/paint_bsdf.h"
#include "appearance/subsurface/translucent_paint.h"
#include "core/colour.h"

namespace livery {

namespace {

constexpr double kVarnishF0 = 0.04;  ///< of an index of 1.5: every coat's, and specular's unit
const glm::dvec3 kNothing(0.0), kWhite(1.0);

double roughness_of(double alpha) { return std::sqrt(std::clamp(alpha, 0.0, 1.0)); }

/// Its colour under 45 degrees from straight above, and as rough as its main lobe.
GltfWords words_of_measured(const Material& paint) {
    const double half = std::sqrt(0.5);
    const glm::dvec3 value = reflectance_of(paint)({half, 0.0, half}, {0.0, 0.0, 1.0});
    GltfWords words;
    words.surface.base_rec709 =
        glm::clamp(rec709_from_working() * value * std::numbers::pi, kNothing, kWhite);
    words.surface.metallic = 0.0;
    words.surface.roughness = roughness_of(static_cast<double>(lobe_alpha(bsdf_of(paint))));
    return words;
}

}  // namespace

GltfWords words_of(const Material& paint) {
    if (is_measured(paint)) return words_of_measured(paint);
    if (is_translucent(paint)) {
        GltfWords words = words_of(albedo_paint(paint));
        words.whole = false;
        return words;
    }
    const ModelInfo& model = model_info(paint.model);
    GltfWords words;
    // What mirrors under a coat, and how rough it is.
    glm::dvec3 f0(0.0);
    glm::dvec2 alpha(1.0);
    if (model.has("f0")) f0 = paint.f0;
    if (model.has("specular")) f0 = paint.specular;
    if (model.has("alpha")) {
        alpha = paint.alpha;
    } else if (model.mirrors()) {
        alpha = glm::dvec2(static_cast<double>(lobe_alpha(bsdf_of(paint))));
    }
    if (model.has("flake_f0")) {
        const glm::dvec3 flakes = (1.0 - f0) * paint.flake_f0;
        const double first = f0.x + f0.y + f0.z, second = flakes.x + flakes.y + flakes.z;
        const double share = first + second > 0.0 ? second / (first + second) : 0.0;
        alpha = glm::mix(alpha, glm::dvec2(paint.flake_alpha), share);
        f0 += flakes;
    }

    // Without a diffuse layer it is a metal, else a dielectric with that reflectance.
    GltfSurface& surface = words.surface;
    surface.metallic = paint.diffuse == kNothing && f0 != kNothing ? 1.0 : 0.0;
    surface.base_rec709 = glm::clamp(surface.metallic > 0.0 ? f0 : paint.diffuse, kNothing, kWhite);
    words.dielectric_f0 =
        surface.metallic > 0.0 ? glm::dvec3(kVarnishF0) : glm::clamp(f0, kNothing, kWhite);

    const double across = std::min(alpha.x, alpha.y), along = std::max(alpha.x, alpha.y);
    surface.roughness = roughness_of(across);
    words.grain_across = alpha.x < alpha.y;
    if (along > across) words.anisotropy = std::sqrt((along - across) / (1.0 - across));
    if (model.has("coat_f0")) {
        surface.coat = std::min(paint.coat_f0 / kVarnishF0, 1.0);
        surface.coat_roughness = roughness_of(paint.coat_alpha);
    }
    const bool same_model =
        paint.model == ReflectanceModel::ggx ||
        (paint.model == ReflectanceModel::clearcoat && paint.coat_f0 <= kVarnishF0 &&
         paint.coat_f0 > 0.0 && paint.coat_transmittance == kWhite);
    words.whole = same_model && (surface.metallic == 0.0 || f0 == surface.base_rec709) &&
                  (surface.metallic > 0.0 || paint.diffuse == surface.base_rec709);
    return words;
}

void put_words(const GltfWords& words, tinygltf::Material& material) {
    using Value = tinygltf::Value;
    const auto list = [](const glm::dvec3& v) {
        return Value(Value::Array{Value(v.x), Value(v.y), Value(v.z)});
    };
    const GltfSurface& surface = words.surface;
    tinygltf::PbrMetallicRoughness& pbr = material.pbrMetallicRoughness;
    pbr.baseColorFactor = {
        surface.base_rec709.x, surface.base_rec709.y, surface.base_rec709.z, 1.0};
    pbr.metallicFactor = surface.metallic;
    pbr.roughnessFactor = surface.roughness;
    if (words.dielectric_f0 != glm::dvec3(kVarnishF0)) {
        material.extensions["KHR_materials_specular"] =
            Value(Value::Object{{"specularColorFactor", list(words.dielectric_f0 / kVarnishF0)}});
    }
    if (words.anisotropy > 0.0) {
        Value::Object anisotropy{{"anisotropyStrength", Value(words.anisotropy)}};
        if (words.grain_across) {
            anisotropy["anisotropyRotation"] = Value(0.5 * std::numbers::pi);
        }
        material.extensions["KHR_materials_anisotropy"] = Value(std::move(anisotropy));
    }
    if (surface.coat > 0.0) {
        material.extensions["KHR_materials_clearcoat"] =
            Value(Value::Object{{"clearcoatFactor", Value(surface.coat)},
                                {"clearcoatRoughnessFactor", Value(surface.coat_roughness)}});
    }
}

}  // namespace livery
