#include "appearance/parameter_table.h"

#include <algorithm>
#include <stdexcept>

#include <fmt/format.h>

#include "appearance/measured/measured_paint.h"
#include "appearance/subsurface/translucent_material.h"

namespace livery {

namespace {

template <typename Vector3>
auto colour(Vector3& v) {
    return std::array{&v.x, &v.y, &v.z};
}
template <typename Real>
std::array<Real*, 3> numbers(Real& first) {
    return {&first, nullptr, nullptr};
}
template <typename Real>
std::array<Real*, 3> numbers(Real& first, Real& second) {
    return {&first, &second, nullptr};
}

/// `of_material` and `of_parameters` give the numbers by reference, of constants as well.
template <typename OfMaterial, typename OfParameters>
ParameterInfo parameter(const char* name,
                        const char* label,
                        const char* meaning,
                        ParameterKind kind,
                        double low,
                        double high,
                        bool logarithmic,
                        OfMaterial of_material,
                        OfParameters of_parameters) {
    return {name,
            label,
            meaning,
            kind,
            low,
            high,
            logarithmic,
            of_material,
            of_material,
            of_parameters,
            of_parameters,
            false};
}

/// The same of one that a file may leave out.
template <typename... Arguments>
ParameterInfo optional_parameter(Arguments... arguments) {
    ParameterInfo info = parameter(arguments...);
    info.optional = true;
    return info;
}

constexpr bool kLinear = false, kByRatios = true;

}  // namespace

const std::vector<ParameterInfo>& parameter_table() {
    static const std::vector<ParameterInfo> table = {
        parameter(
            "diffuse",
            "Diffuse colour",
            "Albedo of the diffuse layer, before the interfaces above it take their share. Under a "
            "clear coat give it the pigment's colour: the coat darkens it.",
            ParameterKind::colour,
            0.0,
            1.0,
            kLinear,
            [](auto& m) { return colour(m.diffuse); },
            [](auto& p) { return colour(p.diffuse); }),
        parameter(
            "diffuse_roughness",
            "Diffuse roughness",
            "Of a diffuse surface by itself: 0 is Lambert's, 1 returns light toward where it came "
            "from, as plaster, clay and the full moon do.",
            ParameterKind::number,
            0.0,
            1.0,
            kLinear,
            [](auto& m) { return numbers(m.diffuse_roughness); },
            [](auto& p) { return numbers(p.diffuse_roughness); }),
        parameter(
            "specular",
            "Highlight",
            "Scale of the highlight: what part of the light its lobe returns, for the models that "
            "have no Fresnel term. With the diffuse colour it should not exceed 1.",
            ParameterKind::colour,
            0.0,
            1.0,
            kLinear,
            [](auto& m) { return colour(m.specular); },
            [](auto& p) { return colour(p.specular); }),
        parameter(
            "exponent",
            "Sharpness",
            "Exponent n of the highlight's cosine, about 2 / alpha^2 - 2 of the half vector: satin "
            "20, gloss 10000.",
            ParameterKind::pair,
            1.0,
            1e6,
            kByRatios,
            [](auto& m) { return numbers(m.exponent.x, m.exponent.y); },
            [](auto& p) { return numbers(p.exponent_x, p.exponent_y); }),
        parameter(
            "f0",
            "Base reflectance",
            "Reflectance of the interface looked at along the normal: 0.04 for an index of 1.5, a "
            "colour for metals and flakes, 0 for no interface.",
            ParameterKind::colour,
            0.0,
            1.0,
            kLinear,
            [](auto& m) { return colour(m.f0); },
            [](auto& p) { return colour(p.f0); }),
        parameter(
            "alpha",
            "Base roughness",
            "Slope parameter of the microfacets: mirror 0.001, satin 0.3, chalk 1. Two values, "
            "along and across the tangent, for brushed surfaces.",
            ParameterKind::pair,
            1e-4,
            1.0,
            kByRatios,
            [](auto& m) { return numbers(m.alpha.x, m.alpha.y); },
            [](auto& p) { return numbers(p.alpha_x, p.alpha_y); }),
        parameter(
            "flake_f0",
            "Flake reflectance",
            "Of car paint's second lobe of flakes, the wider or the narrower; its first is the "
            "base. "
            "It covers what the base leaves: 1 - f0 of it is seen.",
            ParameterKind::colour,
            0.0,
            1.0,
            kLinear,
            [](auto& m) { return colour(m.flake_f0); },
            [](auto& p) { return colour(p.flake_f0); }),
        parameter(
            "flake_alpha",
            "Flake roughness",
            "Slope parameter of the second lobe: how far its flakes lean. Flat flakes 0.05, "
            "tumbled "
            "ones 0.3.",
            ParameterKind::number,
            1e-4,
            1.0,
            kByRatios,
            [](auto& m) { return numbers(m.flake_alpha); },
            [](auto& p) { return numbers(p.flake_alpha); }),
        optional_parameter(
            "film_nm",
            "Film thickness",
            "Of the film on the second lobe's flakes, in nanometres, whose interference colours "
            "change with the angle: pearl 50 to 300, colour shift 300 to 800, 0 for none.",
            ParameterKind::number,
            0.0,
            2000.0,
            kLinear,
            [](auto& m) { return numbers(m.film_nm); },
            [](auto& p) { return numbers(p.film_nm); }),
        optional_parameter(
            "film_eta",
            "Film index",
            "Its refractive index: glass 1.5, iron oxide 2.4, titanium dioxide 2.5. The nearer to "
            "the "
            "varnish's, the paler the colours.",
            ParameterKind::number,
            1.3,
            2.7,
            kLinear,
            [](auto& m) { return numbers(m.film_eta); },
            [](auto& p) { return numbers(p.film_eta); }),
        optional_parameter(
            "glint_density_per_mm2",
            "Glint density",
            "Flakes of the second lobe on a square millimetre of the product, which a projector "
            "pixel shows as single glints where it holds few: fine ones 5000, coarse ones 300, 0 "
            "for a smooth lobe.",
            ParameterKind::number,
            0.0,
            1e6,
            kByRatios,
            [](auto& m) { return numbers(m.glint_density_per_mm2); },
            [](auto& p) { return numbers(p.glint_density_per_mm2); }),
        optional_parameter(
            "glint_scale",
            "Glint scale",
            "How many times larger the glinting flakes are drawn: 1 is physical, as on the real "
            "product; more is exaggerated, to judge graininess on a small mock-up.",
            ParameterKind::number,
            1.0,
            1000.0,
            kByRatios,
            [](auto& m) { return numbers(m.glint_scale); },
            [](auto& p) { return numbers(p.glint_scale); }),
        parameter(
            "coat_alpha",
            "Coat roughness",
            "The same of the coat: polished varnish 0.003 to 0.03.",
            ParameterKind::number,
            1e-4,
            1.0,
            kByRatios,
            [](auto& m) { return numbers(m.coat_alpha); },
            [](auto& p) { return numbers(p.coat_alpha); }),
        parameter(
            "coat_f0",
            "Coat reflectance",
            "The coat's reflectance along the normal, 0.04 for varnish of index 1.5; its index "
            "follows from it.",
            ParameterKind::number,
            0.0,
            0.2,
            kLinear,
            [](auto& m) { return numbers(m.coat_f0); },
            [](auto& p) { return numbers(p.coat_f0); }),
        parameter(
            "coat_transmittance",
            "Coat tint",
            "What the coat lets through, once along the normal: white is clear, a colour is tinted "
            "varnish.",
            ParameterKind::colour,
            0.0,
            1.0,
            kLinear,
            [](auto& m) { return colour(m.coat_transmittance); },
            [](auto& p) { return colour(p.coat_transmittance); }),
    };
    return table;
}

const ParameterInfo& parameter_info(std::string_view name) {
    const auto& table = parameter_table();
    const auto found = std::find_if(
        table.begin(), table.end(), [&](const ParameterInfo& info) { return info.name == name; });
    if (found == table.end()) {
        throw std::invalid_argument(fmt::format("no model has a parameter '{}'", name));
    }
    return *found;
}

int ParameterInfo::count() const {
    return kind == ParameterKind::colour ? 3 : kind == ParameterKind::pair ? 2 : 1;
}

std::string ParameterInfo::range_text() const {
    if (kind == ParameterKind::colour) {
        return fmt::format("{:.7g} to {:.7g} a channel, working space", low, high);
    }
    return fmt::format("{:.7g} to {:.7g}", low, high);
}

std::string ParameterInfo::default_text() const {
    return fmt::format("{:.7g}", value_of(*this, Material{}).x);
}

glm::dvec3 value_of(const ParameterInfo& parameter, const Material& material) {
    const Components<const double> components = parameter.of_material(material);
    glm::dvec3 value(0.0);
    for (int k = 0; k < parameter.count(); ++k) {
        value[k] = *components[static_cast<std::size_t>(k)];
    }
    return value;
}

std::vector<double> reflectance_numbers(const Material& material) {
    std::vector<double> numbers{static_cast<double>(material.model)};
    for (const ParameterInfo& parameter : parameter_table()) {
        const glm::dvec3 value = value_of(parameter, material);
        for (int k = 0; k < parameter.count(); ++k) numbers.push_back(value[k]);
    }
    // A formula chosen for a paint that was measured before looks like any other.
    if (material.model == ReflectanceModel::measured && material.measured) {
        for (std::size_t k = 0; k < material.measured->id.size(); k += 8) {
            numbers.push_back(
                static_cast<double>(std::stoul(material.measured->id.substr(k, 8), nullptr, 16)));
        }
    }
    if (material.model == ReflectanceModel::translucent && material.medium) {
        const TranslucentMaterial& medium = *material.medium;
        for (int c = 0; c < 3; ++c) {
            numbers.push_back(medium.sigma_a_per_mm[c]);
            numbers.push_back(medium.sigma_s_prime_per_mm[c]);
        }
        numbers.push_back(medium.g);
        numbers.push_back(medium.eta);
        numbers.push_back(medium.thickness_mm.value_or(0.0));
    }
    return numbers;
}

bool same_reflectance(const Material& a, const Material& b) {
    return reflectance_numbers(a) == reflectance_numbers(b);
}

}  // namespace livery
