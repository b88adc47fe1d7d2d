#include "appearance/bsdf.h"

#include <cmath>
#include <numbers>
#include <stdexcept>

#include <fmt/format.h>

#include "core/colour.h"
#include "core/paths.h"

namespace livery {

namespace {

glm::dvec3 working_colour(const Material& material, const char* name, glm::dvec3 rec709) {
    glm::dvec3 working = working_from_rec709() * rec709;
    for (int c = 0; c < 3; ++c) {
        // The conversion itself rounds.
        if (!(working[c] >= -1e-6 && working[c] <= 1.0 + 1e-6)) {
            throw std::invalid_argument(fmt::format(
                "paint '{}': {} ({}, {}, {}) in linear Rec.709 is ({}, {}, {}) in the working "
                "space, outside [0, 1]",
                material.name,
                name,
                rec709.x,
                rec709.y,
                rec709.z,
                working.x,
                working.y,
                working.z));
        }
    }
    return glm::clamp(working, 0.0, 1.0);
}

double in_range(const Material& material, const char* name, double value, double low, double high) {
    if (!(value >= low && value <= high)) {
        throw std::invalid_argument(fmt::format(
            "paint '{}': {} is {}, expected {} to {}", material.name, name, value, low, high));
    }
    return value;
}

template <typename To, typename Vec, typename Real, typename From>
To converted(const From& from) {
    To to;
    to.diffuse = Vec(from.diffuse);
    to.f0 = Vec(from.f0);
    to.alpha_x = static_cast<Real>(from.alpha_x);
    to.alpha_y = static_cast<Real>(from.alpha_y);
    to.coat_alpha = static_cast<Real>(from.coat_alpha);
    to.coat_f0 = static_cast<Real>(from.coat_f0);
    to.coat_transmittance = Vec(from.coat_transmittance);
    return to;
}

[[noreturn]] void unknown_model() { throw std::invalid_argument("unknown reflectance model"); }

}  // namespace

f64::BsdfParameters parameters_of_f64(const Material& material) {
    f64::BsdfParameters p;
    p.diffuse = working_colour(material, "diffuse", material.diffuse);
    p.f0 = working_colour(material, "f0", material.f0);
    p.alpha_x = in_range(material, "alpha[0]", material.alpha.x, 1e-4, 1.0);
    p.alpha_y = in_range(material, "alpha[1]", material.alpha.y, 1e-4, 1.0);
    p.coat_alpha = in_range(material, "coat_alpha", material.coat_alpha, 1e-4, 1.0);
    p.coat_f0 = in_range(material, "coat_f0", material.coat_f0, 0.0, 0.2);
    p.coat_transmittance =
        working_colour(material, "coat_transmittance", material.coat_transmittance);
    return p;
}

f32::BsdfParameters parameters_of(const Material& material) {
    return rounded(parameters_of_f64(material));
}

f32::BsdfParameters rounded(const f64::BsdfParameters& parameters) {
    return converted<f32::BsdfParameters, glm::vec3, float>(parameters);
}

f64::BsdfParameters widened(const f32::BsdfParameters& parameters) {
    return converted<f64::BsdfParameters, glm::dvec3, double>(parameters);
}

glm::vec3 evaluate(ReflectanceModel model,
                   const f32::BsdfParameters& parameters,
                   glm::vec3 wi,
                   glm::vec3 wo) {
    switch (model) {
        case ReflectanceModel::lambert:
            return f32::lambert_eval(parameters, wi, wo);
        case ReflectanceModel::ggx:
            return f32::ggx_eval(parameters, wi, wo);
        case ReflectanceModel::clearcoat:
            return f32::clearcoat_eval(parameters, wi, wo);
    }
    unknown_model();
}

glm::dvec3 evaluate(ReflectanceModel model,
                    const f64::BsdfParameters& parameters,
                    glm::dvec3 wi,
                    glm::dvec3 wo) {
    switch (model) {
        case ReflectanceModel::lambert:
            return f64::lambert_eval(parameters, wi, wo);
        case ReflectanceModel::ggx:
            return f64::ggx_eval(parameters, wi, wo);
        case ReflectanceModel::clearcoat:
            return f64::clearcoat_eval(parameters, wi, wo);
    }
    unknown_model();
}

glm::vec3 sample(ReflectanceModel model,
                 const f32::BsdfParameters& parameters,
                 glm::vec3 wo,
                 glm::vec3 u) {
    switch (model) {
        case ReflectanceModel::lambert:
            return f32::lambert_sample(parameters, wo, u);
        case ReflectanceModel::ggx:
            return f32::ggx_sample(parameters, wo, u);
        case ReflectanceModel::clearcoat:
            return f32::clearcoat_sample(parameters, wo, u);
    }
    unknown_model();
}

glm::dvec3 sample(ReflectanceModel model,
                  const f64::BsdfParameters& parameters,
                  glm::dvec3 wo,
                  glm::dvec3 u) {
    switch (model) {
        case ReflectanceModel::lambert:
            return f64::lambert_sample(parameters, wo, u);
        case ReflectanceModel::ggx:
            return f64::ggx_sample(parameters, wo, u);
        case ReflectanceModel::clearcoat:
            return f64::clearcoat_sample(parameters, wo, u);
    }
    unknown_model();
}

float pdf(ReflectanceModel model,
          const f32::BsdfParameters& parameters,
          glm::vec3 wi,
          glm::vec3 wo) {
    switch (model) {
        case ReflectanceModel::lambert:
            return f32::lambert_pdf(parameters, wi, wo);
        case ReflectanceModel::ggx:
            return f32::ggx_pdf(parameters, wi, wo);
        case ReflectanceModel::clearcoat:
            return f32::clearcoat_pdf(parameters, wi, wo);
    }
    unknown_model();
}

double pdf(ReflectanceModel model,
           const f64::BsdfParameters& parameters,
           glm::dvec3 wi,
           glm::dvec3 wo) {
    switch (model) {
        case ReflectanceModel::lambert:
            return f64::lambert_pdf(parameters, wi, wo);
        case ReflectanceModel::ggx:
            return f64::ggx_pdf(parameters, wi, wo);
        case ReflectanceModel::clearcoat:
            return f64::clearcoat_pdf(parameters, wi, wo);
    }
    unknown_model();
}

f32::BsdfEnvironment environment_weights(ReflectanceModel model,
                                         const f32::BsdfParameters& parameters,
                                         float mu) {
    switch (model) {
        case ReflectanceModel::lambert:
            return f32::lambert_environment(parameters, mu);
        case ReflectanceModel::ggx:
            return f32::ggx_environment(parameters, mu);
        case ReflectanceModel::clearcoat:
            return f32::clearcoat_environment(parameters, mu);
    }
    unknown_model();
}

glm::dvec3 directional_albedo(ReflectanceModel model,
                              const f64::BsdfParameters& p,
                              glm::dvec3 wo,
                              int points) {
    if (!(wo.z > 0.0)) return glm::dvec3(0.0);
    // Every lobe by itself, in the map of the unit square that its own sampling gives: there it is
    // smooth however narrow. The lobes are differences of the model with and without a parameter.
    f64::BsdfParameters no_diffuse = p;
    no_diffuse.diffuse = glm::dvec3(0.0);
    f64::BsdfParameters only_coat = no_diffuse;
    only_coat.f0 = glm::dvec3(0.0);
    const bool has_base = model != ReflectanceModel::lambert;
    const bool has_coat = model == ReflectanceModel::clearcoat;
    glm::dvec3 total(0.0);
    const auto add_lobe = [&](glm::dvec2 u,
                              double alpha_x,
                              double alpha_y,
                              const f64::BsdfParameters& with,
                              const f64::BsdfParameters* without) {
        const glm::dvec3 wi = f64::ggx_sample_lobe(wo, u, alpha_x, alpha_y);
        if (!(wi.z > 0.0)) return;
        glm::dvec3 value = evaluate(model, with, wi, wo);
        if (without) value -= evaluate(model, *without, wi, wo);
        total += value * (wi.z / f64::ggx_pdf_lobe(wi, wo, alpha_x, alpha_y));
    };
    for (int i = 0; i < points; ++i) {
        for (int j = 0; j < points; ++j) {
            const glm::dvec2 u((i + 0.5) / points, (j + 0.5) / points);
            // Even steps of the cosine: near grazing the equal-area map is not smooth.
            const double mu = u.x;
            const double sine = std::sqrt((1.0 - mu) * (1.0 + mu));
            const double phi = 2.0 * std::numbers::pi * u.y;
            const glm::dvec3 wi(sine * std::cos(phi), sine * std::sin(phi), mu);
            total += (evaluate(model, p, wi, wo) - evaluate(model, no_diffuse, wi, wo)) *
                     (2.0 * std::numbers::pi * mu);
            if (has_coat) add_lobe(u, p.coat_alpha, p.coat_alpha, only_coat, nullptr);
            if (has_base) {
                add_lobe(u, p.alpha_x, p.alpha_y, no_diffuse, has_coat ? &only_coat : nullptr);
            }
        }
    }
    return total / (static_cast<double>(points) * points);
}

std::string bsdf_glsl(ReflectanceModel model) {
    const auto source = [](const char* name) {
        return read_text_file(shipped_path(std::filesystem::path("shaders/bsdf") / name)) + "\n";
    };
    std::string text = source("prelude_glsl.glsl") + source("parameters.glsl");
    std::string prefix;
    switch (model) {
        case ReflectanceModel::lambert:
            text += source("lambert.glsl");
            prefix = "lambert";
            break;
        case ReflectanceModel::ggx:
            text += source("microfacet.glsl") + source("ggx.glsl");
            prefix = "ggx";
            break;
        case ReflectanceModel::clearcoat:
            text += source("microfacet.glsl") + source("ggx.glsl") + source("clearcoat.glsl");
            prefix = "clearcoat";
            break;
    }
    for (const char* what : {"eval", "sample", "pdf", "environment"}) {
        text += fmt::format("#define bsdf_{} {}_{}\n", what, prefix, what);
    }
    return text;
}

}  // namespace livery
