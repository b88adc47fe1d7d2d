#include "appearance/bsdf.h"

#include <cmath>
#include <numbers>
#include <sstream>
#include <stdexcept>

#include <fmt/format.h>

#include "appearance/measured/measured_grid.h"
#include "appearance/model_table.h"
#include "appearance/subsurface/translucent_paint.h"
#include "core/colour.h"
#include "core/paths.h"

namespace livery {

namespace {

glm::dvec3 working_colour(const Material& material,
                          const ParameterInfo& parameter,
                          glm::dvec3 rec709) {
    glm::dvec3 working = working_from_rec709() * rec709;
    for (int c = 0; c < 3; ++c) {
        // The conversion itself rounds.
        if (!(working[c] >= parameter.low - 1e-6 && working[c] <= parameter.high + 1e-6)) {
            throw std::invalid_argument(fmt::format(
                "paint '{}': {} ({}, {}, {}) in linear Rec.709 is ({}, {}, {}) in the working "
                "space, outside [{}, {}]",
                material.name,
                parameter.name,
                rec709.x,
                rec709.y,
                rec709.z,
                working.x,
                working.y,
                working.z,
                parameter.low,
                parameter.high));
        }
    }
    return glm::clamp(working, parameter.low, parameter.high);
}

void check_range(const Material& material,
                 const ParameterInfo& parameter,
                 const glm::dvec3& value) {
    for (int k = 0; k < parameter.count(); ++k) {
        if (value[k] >= parameter.low && value[k] <= parameter.high) continue;
        throw std::invalid_argument(fmt::format(
            "paint '{}': {} is {}, expected {}",
            material.name,
            parameter.count() > 1 ? fmt::format("{}[{}]", parameter.name, k) : parameter.name,
            value[k],
            parameter.range_text()));
    }
}

template <typename To, typename Real, typename From, typename FromOf, typename ToOf>
To converted(From from, FromOf from_of, ToOf to_of) {
    To to{};
    for (const ParameterInfo& parameter : parameter_table()) {
        const auto in = (parameter.*from_of)(from);
        const auto out = (parameter.*to_of)(to);
        for (std::size_t k = 0; k < static_cast<std::size_t>(parameter.count()); ++k) {
            *out[k] = static_cast<Real>(*in[k]);
        }
    }
    return to;
}

}  // namespace

f64::BsdfParameters parameters_of_f64(const Material& material) {
    if (material.model == ReflectanceModel::translucent) {
        return parameters_of_f64(albedo_paint(material));
    }
    f64::BsdfParameters p{};
    for (const ParameterInfo& parameter : parameter_table()) {
        glm::dvec3 value = value_of(parameter, material);
        if (parameter.kind == ParameterKind::colour) {
            value = working_colour(material, parameter, value);
        } else {
            check_range(material, parameter, value);
        }
        const Components<double> components = parameter.in_f64(p);
        for (int k = 0; k < parameter.count(); ++k) {
            *components[static_cast<std::size_t>(k)] = value[k];
        }
    }
    return p;
}

f32::BsdfParameters parameters_of(const Material& material) {
    return rounded(parameters_of_f64(material));
}

f32::BsdfParameters rounded(const f64::BsdfParameters& parameters) {
    return converted<f32::BsdfParameters, float>(
        parameters, &ParameterInfo::in_f64, &ParameterInfo::in_f32);
}

f64::BsdfParameters widened(const f32::BsdfParameters& parameters) {
    return converted<f64::BsdfParameters, double>(
        parameters, &ParameterInfo::in_f32, &ParameterInfo::in_f64);
}

glm::vec3 evaluate(ReflectanceModel model,
                   const f32::BsdfParameters& parameters,
                   glm::vec3 wi,
                   glm::vec3 wo) {
    return model_info(model).f32.eval(parameters, wi, wo);
}

glm::dvec3 evaluate(ReflectanceModel model,
                    const f64::BsdfParameters& parameters,
                    glm::dvec3 wi,
                    glm::dvec3 wo) {
    return model_info(model).f64.eval(parameters, wi, wo);
}

glm::vec3 sample(ReflectanceModel model,
                 const f32::BsdfParameters& parameters,
                 glm::vec3 wo,
                 glm::vec3 u) {
    return model_info(model).f32.sample(parameters, wo, u);
}

glm::dvec3 sample(ReflectanceModel model,
                  const f64::BsdfParameters& parameters,
                  glm::dvec3 wo,
                  glm::dvec3 u) {
    return model_info(model).f64.sample(parameters, wo, u);
}

float pdf(ReflectanceModel model,
          const f32::BsdfParameters& parameters,
          glm::vec3 wi,
          glm::vec3 wo) {
    return model_info(model).f32.pdf(parameters, wi, wo);
}

double pdf(ReflectanceModel model,
           const f64::BsdfParameters& parameters,
           glm::dvec3 wi,
           glm::dvec3 wo) {
    return model_info(model).f64.pdf(parameters, wi, wo);
}

f32::BsdfEnvironment environment_weights(ReflectanceModel model,
                                         const f32::BsdfParameters& parameters,
                                         float mu) {
    return model_info(model).f32.environment(parameters, mu);
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
    f64::BsdfParameters no_flakes = no_diffuse;
    no_flakes.flake_f0 = glm::dvec3(0.0);
    no_flakes.film_nm = 0.0;
    f64::BsdfParameters only_coat = no_flakes;
    only_coat.f0 = glm::dvec3(0.0);
    const bool has_lobe = model_info(model).mirrors();
    const bool has_coat = model_info(model).has("coat_alpha");
    const bool has_flakes = model_info(model).has("flake_alpha");
    // Many bounces are as smooth as a diffuse layer.
    const ReflectanceModel lobes =
        model == ReflectanceModel::ggx_multiscatter ? ReflectanceModel::ggx : model;
    const auto whole = model_info(model).f64.bound(p);
    const auto mirrored = model_info(lobes).f64.bound(no_diffuse);
    const auto without_flakes = model_info(model).f64.bound(no_flakes);
    const auto coat_alone = model_info(model).f64.bound(only_coat);
    const auto smooth = [&](const glm::dvec3& wi) {
        glm::dvec3 value = whole->eval(wi, wo);
        if (has_lobe) value -= mirrored->eval(wi, wo);
        return value;
    };
    glm::dvec3 total(0.0);
    // Many points near both ends, where integrands have edges.
    const auto crowded = [](double s) { return s * s * s * (10.0 - s * (15.0 - 6.0 * s)); };
    const auto add = [&](const glm::dvec3& wi, const glm::dvec3& value, double density) {
        if (wi.z > 0.0 && density > 0.0) total += value * (wi.z / density);
    };
    for (int i = 0; i < points; ++i) {
        for (int j = 0; j < points; ++j) {
            const double s = (j + 0.5) / points;
            const glm::dvec2 u((i + 0.5) / points, crowded(s));
            const double share = 30.0 * s * s * (1.0 - s) * (1.0 - s);
            const double sine = std::sqrt((1.0 - u.y) * (1.0 + u.y));
            const double phi = 2.0 * std::numbers::pi * u.x;
            const glm::dvec3 even(sine * std::cos(phi), sine * std::sin(phi), u.y);
            add(even, share * smooth(even), 0.5 / std::numbers::pi);
            if (has_coat) {
                const glm::dvec3 coat = f64::ggx_sample_lobe(wo, u, p.coat_alpha, p.coat_alpha);
                add(coat,
                    share * coat_alone->eval(coat, wo),
                    f64::ggx_pdf_lobe(coat, wo, p.coat_alpha, p.coat_alpha));
                const glm::dvec3 base = f64::ggx_sample_lobe(wo, u, p.alpha_x, p.alpha_y);
                add(base,
                    share * (without_flakes->eval(base, wo) - coat_alone->eval(base, wo)),
                    f64::ggx_pdf_lobe(base, wo, p.alpha_x, p.alpha_y));
                if (!has_flakes) continue;
                const glm::dvec3 flakes = f64::ggx_sample_lobe(wo, u, p.flake_alpha, p.flake_alpha);
                add(flakes,
                    share * (mirrored->eval(flakes, wo) - without_flakes->eval(flakes, wo)),
                    f64::ggx_pdf_lobe(flakes, wo, p.flake_alpha, p.flake_alpha));
            } else if (has_lobe) {
                const glm::dvec3 wi = mirrored->sample(wo, {u.x, u.y, 0.0});
                add(wi, share * mirrored->eval(wi, wo), mirrored->pdf(wi, wo));
            }
        }
    }
    return total / (static_cast<double>(points) * points);
}

namespace {

std::string source(const char* name) {
    return read_text_file(shipped_path(std::filesystem::path("shaders/bsdf") / name)) + "\n";
}

void append_fields(const std::string& text,
                   const std::string& type,
                   const std::string& prefix,
                   std::vector<PreparedField>* fields) {
    const std::size_t begin = text.find("struct " + type + " {");
    if (begin == std::string::npos) {
        throw std::logic_error(fmt::format("no shader file declares struct {}", type));
    }
    std::istringstream lines(text.substr(begin, text.find("};", begin) - begin));
    for (std::string line; std::getline(lines, line);) {
        std::istringstream words(line);
        std::string kind, name;
        if (!(words >> kind >> name) || kind == "//" || name.back() != ';') continue;
        name = prefix + name.substr(0, name.size() - 1);
        if (kind == "REAL" || kind == "VEC3") {
            fields->push_back({name, kind == "REAL" ? std::size_t{1} : std::size_t{3}});
        } else {
            append_fields(text, kind, name + ".", fields);
        }
    }
}

}  // namespace

std::vector<PreparedField> prepared_fields(ReflectanceModel model) {
    const ModelInfo& info = model_info(model);
    std::string text;
    for (const char* file : info.shaders) text += source(file);
    std::vector<PreparedField> fields;
    if (info.prepared.type) append_fields(text, info.prepared.type, "", &fields);
    return fields;
}

std::string bsdf_glsl(ReflectanceModel model) {
    if (model == ReflectanceModel::measured) {
        return measured_glsl() + source("parameters.glsl") +
               "uniform sampler2DArray u_measured;\n"
               "#define bsdf_eval(p, wi, wo) max(measured_eval(u_measured, wi, wo), vec3(0.0))\n";
    }
    const ModelInfo& info = model_info(model);
    std::string text = source("prelude_glsl.glsl") + source("parameters.glsl");
    for (const char* file : info.shaders) text += source(file);
    for (const char* what : {"eval", "sample", "pdf", "environment"}) {
        text += fmt::format("#define bsdf_{} {}_{}\n", what, info.prefix, what);
    }
    return text;
}

}  // namespace livery
