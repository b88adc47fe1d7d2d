#include "studio/paint_parameters.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

#include "appearance/bsdf.h"
#include "core/colour.h"

namespace livery {

namespace {

constexpr const char* kColourRange = "0 to 1 a channel, working space";
constexpr const char* kAlphaRange = "0.0001 to 1";

constexpr std::array kParameters{
    ParameterText{"diffuse",
                  "Diffuse colour",
                  kColourRange,
                  "Albedo of the diffuse layer, before the interfaces above it take their share. "
                  "Under a clear coat give it the pigment's colour: the coat darkens it."},
    ParameterText{"f0",
                  "Base reflectance",
                  kColourRange,
                  "Reflectance of the interface looked at along the normal: 0.04 for varnish, a "
                  "colour for metals and flakes, 0 for no interface."},
    ParameterText{"alpha",
                  "Base roughness",
                  kAlphaRange,
                  "GGX slope parameter: mirror 0.001, satin 0.3, chalk 1. Two values, along and "
                  "across, for brushed surfaces."},
    ParameterText{"coat_alpha",
                  "Coat roughness",
                  kAlphaRange,
                  "GGX slope parameter of the coat: polished varnish 0.01 to 0.03."},
    ParameterText{"coat_f0",
                  "Coat reflectance",
                  "0 to 0.2",
                  "The coat's reflectance along the normal: 0.04 for varnish of index 1.5."},
    ParameterText{"coat_transmittance",
                  "Coat tint",
                  kColourRange,
                  "What the coat lets through, once along the normal: white is clear, a colour is "
                  "tinted varnish."}};

std::string numbers(const glm::dvec3& colour) {
    return fmt::format("{:.3g} {:.3g} {:.3g}", colour.x, colour.y, colour.z);
}

int hex_digit(char c) {
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    if (c >= 'A' && c <= 'F') return c - 'A' + 10;
    return -1;
}

}  // namespace

const ParameterText& parameter_text(const std::string& name) {
    const auto found = std::find_if(kParameters.begin(),
                                    kParameters.end(),
                                    [&](const ParameterText& text) { return text.name == name; });
    if (found == kParameters.end()) {
        throw std::invalid_argument(fmt::format("no model has a parameter '{}'", name));
    }
    return *found;
}

const std::vector<std::string>& parameters_of_model(ReflectanceModel model) {
    static const std::vector<std::string> lambert{"diffuse"}, ggx{"diffuse", "f0", "alpha"},
        clearcoat{"diffuse", "f0", "alpha", "coat_alpha", "coat_f0", "coat_transmittance"};
    switch (model) {
        case ReflectanceModel::lambert:
            return lambert;
        case ReflectanceModel::ggx:
            return ggx;
        case ReflectanceModel::clearcoat:
            return clearcoat;
    }
    throw std::invalid_argument("unknown reflectance model");
}

const ModelText& model_text(ReflectanceModel model) {
    static constexpr ModelText lambert{
        "lambert", "Plain diffuse", "The same radiance in all directions."},
        ggx{"ggx", "Glossy or matte", "A rough interface (GGX) over a diffuse layer."},
        clearcoat{"clearcoat",
                  "Clear coat",
                  "A clear coat over a rough interface: solid and metallic car paint."};
    switch (model) {
        case ReflectanceModel::lambert:
            return lambert;
        case ReflectanceModel::ggx:
            return ggx;
        case ReflectanceModel::clearcoat:
            return clearcoat;
    }
    throw std::invalid_argument("unknown reflectance model");
}

std::string summary_of(const Material& material) {
    std::string text = model_text(material.model).label;
    const auto line = [&](const char* name, const std::string& value) {
        text += fmt::format("\n{} {}", parameter_text(name).label, value);
    };
    line("diffuse", numbers(material.diffuse));
    if (material.model == ReflectanceModel::lambert) return text;
    line("f0", numbers(material.f0));
    line("alpha",
         material.alpha.x == material.alpha.y
             ? fmt::format("{:.3g}", material.alpha.x)
             : fmt::format("{:.3g} along, {:.3g} across", material.alpha.x, material.alpha.y));
    if (material.model == ReflectanceModel::clearcoat) {
        line("coat_alpha", fmt::format("{:.3g}", material.coat_alpha));
        if (material.coat_transmittance != glm::dvec3(1.0)) {
            line("coat_transmittance", numbers(material.coat_transmittance));
        }
    }
    return text;
}

std::optional<std::string> paint_problem(const Material& material) {
    try {
        parameters_of_f64(material);
    } catch (const std::invalid_argument& mistake) {
        return mistake.what();
    }
    return std::nullopt;
}

bool in_srgb(const glm::dvec3& linear_rec709) {
    for (int c = 0; c < 3; ++c) {
        if (!(linear_rec709[c] >= 0.0 && linear_rec709[c] <= 1.0)) return false;
    }
    return true;
}

std::string hex_of(const glm::dvec3& linear_rec709) {
    std::string text = "#";
    for (int c = 0; c < 3; ++c) {
        const double encoded = srgb_encode(std::clamp(linear_rec709[c], 0.0, 1.0));
        text += fmt::format("{:02x}", static_cast<int>(std::lround(255.0 * encoded)));
    }
    return text;
}

std::optional<glm::dvec3> colour_of_hex(const std::string& text) {
    std::string digits = text;
    digits.erase(std::remove(digits.begin(), digits.end(), ' '), digits.end());
    if (!digits.empty() && digits.front() == '#') digits.erase(0, 1);
    if (digits.size() == 3) {
        digits = {digits[0], digits[0], digits[1], digits[1], digits[2], digits[2]};
    }
    if (digits.size() != 6) return std::nullopt;
    glm::dvec3 colour;
    for (std::size_t c = 0; c < 3; ++c) {
        const int high = hex_digit(digits[2 * c]), low = hex_digit(digits[2 * c + 1]);
        if (high < 0 || low < 0) return std::nullopt;
        colour[static_cast<int>(c)] = srgb_decode((16 * high + low) / 255.0);
    }
    return colour;
}

const Material* library_origin(const std::string& name, const PaintLibrary& library) {
    const auto last = name.find_last_not_of("0123456789");
    if (last == std::string::npos || last + 1 == name.size() || name[last] != ' ') return nullptr;
    return library.find(name.substr(0, last));
}

}  // namespace livery
