#include "studio/paint/paint_parameters.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string_view>

#include <fmt/format.h>

#include "appearance/bsdf.h"
#include "appearance/measured/measured_paint.h"
#include "appearance/model_table.h"
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

const Material* library_origin(const std::string& name, const PaintLibrary& library) {
    const auto last = name.find_last_not_of("0123456789");
    if (last == std::string::npos || last + 1 == name.size() || name[last] != ' ') return nullptr;
    return library.find(name.substr(0, last));
}

}  // namespace livery
