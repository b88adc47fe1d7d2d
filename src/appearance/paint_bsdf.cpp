#include "appearance/paint_bsdf.h"

#include <stdexcept>

#include <fmt/format.h>

#include "appearance/model_table.h"

namespace livery {

PaintBsdf bsdf_of(const Material& material) {
    PaintBsdf bsdf;
    bsdf.model = material.model;
    if (material.model != ReflectanceModel::measured) {
        bsdf.parameters = parameters_of(material);
        bsdf.bound = model_info(material.model).f32.bound(bsdf.parameters);
        return bsdf;
    }
    if (!material.measured) {
        throw std::invalid_argument(
            fmt::format("paint '{}' is measured, but by no file", material.name));
    }
    bsdf.measured = material.measured;
    return bsdf;
}

ReflectanceFunction reflectance_of(const Material& material) {
    const PaintBsdf bsdf = bsdf_of(material);
    if (bsdf.measured) {
        return [bsdf](const glm::dvec3& wi, const glm::dvec3& wo) {
            return glm::dvec3(evaluate(*bsdf.measured, glm::vec3(wi), glm::vec3(wo)));
        };
    }
    return [bound = model_info(material.model).f64.bound(parameters_of_f64(material))](
               const glm::dvec3& wi, const glm::dvec3& wo) { return bound->eval(wi, wo); };
}

glm::vec3 evaluate(const PaintBsdf& bsdf, glm::vec3 wi, glm::vec3 wo) {
    return bsdf.measured ? evaluate(*bsdf.measured, wi, wo) : bsdf.bound->eval(wi, wo);
}

glm::vec3 sample(const PaintBsdf& bsdf, glm::vec3 wo, glm::vec3 u) {
    return bsdf.measured ? sample(*bsdf.measured, wo, u) : bsdf.bound->sample(wo, u);
}

float pdf(const PaintBsdf& bsdf, glm::vec3 wi, glm::vec3 wo) {
    return bsdf.measured ? pdf(*bsdf.measured, wi, wo) : bsdf.bound->pdf(wi, wo);
}

f32::BsdfEnvironment environment_weights(const PaintBsdf& bsdf, float mu) {
    return bsdf.measured ? environment_weights(*bsdf.measured, mu)
                         : environment_weights(bsdf.model, bsdf.parameters, mu);
}

glm::vec3 hemispherical_albedo(const PaintBsdf& bsdf) {
    // Gauss and Legendre's three nodes for the cosine from 0 to 1, each under twice its cosine
    constexpr std::array<float, 3> kCosine{0.11270167f, 0.5f, 0.88729833f};
    constexpr std::array<float, 3> kWeight{0.27777778f, 0.44444444f, 0.27777778f};
    glm::vec3 albedo(0.0f);
    for (std::size_t k = 0; k < kCosine.size(); ++k) {
        const f32::BsdfEnvironment weights = environment_weights(bsdf, kCosine[k]);
        albedo +=
            2.0f * kCosine[k] * kWeight[k] * (weights.diffuse + weights.specular + weights.coat);
    }
    return glm::min(albedo, glm::vec3(1.0f));
}

float lobe_alpha(const PaintBsdf& bsdf) {
    return bsdf.measured ? bsdf.measured->lobe_alpha
                         : lobe_alpha(model_info(bsdf.model), bsdf.parameters);
}

}  // namespace livery
