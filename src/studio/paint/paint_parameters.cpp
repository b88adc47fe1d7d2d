#include "studio/paint/paint_parameters.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string_view>

#include <fmt/format.h>

#include "appearance/bsdf.h"
#include "appearance/measured/measured_paint.h"
#include "appearance/model_table.h"
#include "core/colour.h"
#include "studio/kit/words.h"

namespace livery {

namespace {

/// Below 0 lies what sRGB cannot show.
std::string numbers(const glm::dvec3& colour) {
    return fmt::format("{} {} {}",
                       readable_number(std::max(colour.x, 0.0)),
                       readable_number(std::max(colour.y, 0.0)),
                       readable_number(std::max(colour.z, 0.0)));
}

int hex_digit(char c) {
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    if (c >= 'A' && c <= 'F') return c - 'A' + 10;
    return -1;
}

}  // namespace

std::string unit_of(const ParameterInfo& parameter) {
    return std::string_view(parameter.name).ends_with("_nm") ? "nm" : "";
}

std::string summary_of(const Material& material) {
    const ModelInfo& model = model_info(material.model);
    std::string text = model.label;
    if (is_measured(material) && material.measured) {
        text += "\n" + material.measured->file.filename().string();
    }
    for (const char* name : model.parameters) {
        const ParameterInfo& parameter = parameter_info(name);
        const glm::dvec3 value = value_of(parameter, material);
        if (value == value_of(parameter, Material{})) continue;
        const std::string unit = unit_of(parameter);
        std::string shown = readable_number(value.x) + (unit.empty() ? "" : " " + unit);
        if (parameter.kind == ParameterKind::colour) shown = numbers(value);
        if (parameter.kind == ParameterKind::pair && model.anisotropic && value.x != value.y) {
            shown = fmt::format(
                "{} along, {} across", readable_number(value.x), readable_number(value.y));
        }
        text += fmt::format("\n{} {}", parameter.label, shown);
    }
    if (has_glints(material)) text += "\nGlints " + glint_scale_text(material);
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
